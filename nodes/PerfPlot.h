// The values of a scrolling graph, and how they are written.
#ifndef SOTERRAIN_PERFPLOT_H
#define SOTERRAIN_PERFPLOT_H

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

/// The end of a scale for values up to `largest`: 1, 2 or 5 times a power of ten, or `before` while that serves.
double scaleTop(double largest, double before);
/// With three digits that count: 1234567 triangles are "1.23 M", 20480 of unit "B" are "20.5 kB", and what is no number is "-".
std::string shortNumber(double value, const std::string & unit);
/// The same without zeros that say nothing, for round numbers: "2 ms".
std::string roundNumber(double value, const std::string & unit);

/// Values of the latest frames. Where there are more frames than points, a point stands for several and keeps their least and largest
/// value, so that no peak is lost.
class PerfPlot {
public:
    struct Point {
        float low = 0.0f, high = 0.0f;
    };

    /// Values that are not finite count as 0. Forgets all when frames do not go into points as before.
    void add(double value, std::size_t history, std::size_t mostPoints);
    /// Sets the scale: `maximum` if it is above 0, else so that all values fit.
    void scale(double maximum);

    /// Of the latest frame; NaN before the first.
    double value() const { return value_; }
    double top() const { return top_; }
    /// 0, or below where values are.
    double bottom() const { return bottom_; }
    /// Points that a full graph has.
    std::size_t capacity() const { return capacity_; }
    std::size_t size() const { return points_.size(); }
    /// Whether points have a low and a high of their own.
    bool isCondensed() const { return framesPerPoint_ > 1; }
    /// From the oldest on.
    template <class Visit>
    void visit(const Visit & visit) const
    {
        for (std::size_t i = next_; i < points_.size(); ++i) visit(points_[i]);
        for (std::size_t i = 0; i < next_; ++i) visit(points_[i]);
    }

private:
    std::vector<Point> points_;  ///< a ring once it is full
    std::size_t next_ = 0;       ///< the oldest point of a full ring
    std::size_t capacity_ = 0;
    std::size_t framesPerPoint_ = 0, framesOfLatest_ = 0;
    double value_ = std::numeric_limits<double>::quiet_NaN();
    double top_ = 1.0, bottom_ = 0.0;
};

#endif
