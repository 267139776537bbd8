// What a soak measures, and what it says at its end.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

namespace soak {

/// What the process holds now.
struct Reading {
    double seconds = 0.0;
    double residentMegabytes = 0.0;
    double heapMegabytes = 0.0;  ///< allocated and not freed, whatever the allocator keeps
    double glMegabytes = 0.0;    ///< as terrain nodes report it
    std::vector<std::size_t> glObjects;
    int threads = 0;
    int files = 0;
    double meanFrameMilliseconds = 0.0, longestFrameMilliseconds = 0.0;
    double coinMegabytes = 0.0;  ///< of the heap, what Coin keeps of contexts that went
    bool atRest = false;         ///< all nodes and contexts are gone
};

/// Reads memory, threads and open files. `trim`: gives the system back what the allocator keeps, so that readings compare.
Reading readProcess(bool trim);

/// Rows of readings as a CSV file.
class Table {
public:
    /// Nothing is written without a name.
    Table(const std::string& path, const std::vector<std::string>& glKinds);
    ~Table();
    Table(const Table&) = delete;
    Table& operator=(const Table&) = delete;
    bool isGood() const { return path_.empty() || file_; }
    void add(const Reading& reading);
    /// Has gnuplot draw it, where that is installed.
    void plot(const std::string& picture);

private:
    std::string path_;
    std::FILE* file_ = nullptr;
};

/// By how much a quantity may grow over the whole run: a share of it and something besides.
struct Tolerance {
    double share;
    double besides;
};

/// Growth over a series of equal states: the median of all slopes between two of them (Sen 1968), times the length. A single high
/// or low reading does not move it.
double growth(const std::vector<double>& series);

/// What grew in the readings at rest after the first quarter, one line each with figures; `grew` counts the lines that break a
/// tolerance.
std::string verdict(const std::vector<Reading>& atRest, const std::vector<std::string>& glKinds, int& grew);

}  // namespace soak
