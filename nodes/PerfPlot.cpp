#include "PerfPlot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

// What is less is nothing; the scale's inverse stays a float.
constexpr double kLeast = 1e-30;

}  // namespace

double scaleTop(double largest, double before)
{
    if (!(largest > kLeast) || !std::isfinite(largest)) return before > 0.0 ? before : 1.0;
    // A scale that follows every peak at once cannot be read.
    if (largest <= before && largest > 0.2 * before) return before;
    const double power = std::pow(10.0, std::floor(std::log10(largest)));
    for (const double step : {1.0, 2.0, 5.0})
        if (largest <= step * power) return step * power;
    return 10.0 * power;
}

std::string shortNumber(double value, const std::string & unit)
{
    if (!std::isfinite(value)) return "-";
    static constexpr const char * kPrefixes[] = {"", "k", "M", "G", "T"};
    int thousands = 0;
    // "kms" is no unit that anybody reads.
    const bool takesPrefix = unit.empty() || unit == "B";
    for (; takesPrefix && std::fabs(value) >= (unit.empty() ? 9999.5 : 999.5) && thousands < 4; ++thousands) value /= 1000.0;
    const double size = std::fabs(value);
    char text[48];
    if (size >= 999999.5 || (size > 0.0 && size < 0.01))
        std::snprintf(text, sizeof text, "%.2g", value);
    else
        // The second threshold of each is what the last digit would round up to.
        std::snprintf(text, sizeof text, "%.*f", size == 0.0 || size >= 99.95 || (unit == "B" && thousands == 0) ? 0 : size < 9.995 ? 2 : 1, value);
    const std::string suffix = kPrefixes[thousands] + unit;
    return suffix.empty() ? text : text + (' ' + suffix);
}

std::string roundNumber(double value, const std::string & unit)
{
    std::string text = shortNumber(value, unit);
    const std::size_t point = text.find('.'), end = std::min(text.find_first_of(" e"), text.size());
    if (point >= end) return text;
    const std::size_t last = text.find_last_not_of('0', end - 1);
    const std::size_t keep = last == point ? point : last + 1;
    return text.erase(keep, end - keep);
}

void PerfPlot::add(double value, std::size_t history, std::size_t mostPoints)
{
    const std::size_t perPoint = (history + mostPoints - 1) / mostPoints, capacity = (history + perPoint - 1) / perPoint;
    if (perPoint != framesPerPoint_ || capacity != capacity_) {
        points_.clear();
        points_.reserve(capacity);
        next_ = framesOfLatest_ = 0;
        framesPerPoint_ = perPoint;
        capacity_ = capacity;
    }
    value_ = value;
    const float shown = std::isfinite(value) ? float(std::clamp(value, -1e30, 1e30)) : 0.0f;
    if (framesOfLatest_ > 0 && framesOfLatest_ < framesPerPoint_) {
        Point & latest = points_[next_ > 0 ? next_ - 1 : points_.size() - 1];
        latest = {std::min(latest.low, shown), std::max(latest.high, shown)};
        ++framesOfLatest_;
        return;
    }
    framesOfLatest_ = 1;
    if (points_.size() < capacity_) {
        points_.push_back({shown, shown});
    } else {
        points_[next_] = {shown, shown};
        next_ = (next_ + 1) % capacity_;
    }
}

void PerfPlot::scale(double maximum)
{
    float low = 0.0f, high = 0.0f;
    for (const Point & point : points_) {
        low = std::min(low, point.low);
        high = std::max(high, point.high);
    }
    top_ = maximum > kLeast && std::isfinite(maximum) ? maximum : scaleTop(double(high), top_);
    bottom_ = low < 0.0f ? -scaleTop(-double(low), -bottom_) : 0.0;
}
