// Summaries of series of measurements.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace app {

/// The value below which the given part of the sorted values lies: the sample at floor(part * n). 0 without values.
inline double quantile(const std::vector<double>& sorted, double part) {
    if (sorted.empty()) return 0.0;
    return sorted[std::min(sorted.size() - 1, std::size_t(part * double(sorted.size())))];
}

struct Summary {
    double mean = 0.0;
    double median = 0.0;
    double p95 = 0.0;
    double worst = 0.0;  ///< the greatest
};

inline Summary summarize(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    return {sum / double(values.size()), quantile(values, 0.5), quantile(values, 0.95), values.back()};
}

}  // namespace app
