// A plot of heights along a measured line.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <QWidget>

#include "HeightTools.h"

namespace app {

/// Distance to the right, height upwards, with units; a cursor follows the mouse, and tells who listens of the place.
class ProfilePlot : public QWidget {
public:
    explicit ProfilePlot(QWidget* parent = nullptr);

    void setLine(const MeasuredLine& line, const std::string& unit);
    /// Who is told of the distance that the cursor is at; of none when it leaves.
    void onCursor(std::function<void(std::optional<double>)> tell) { tell_ = std::move(tell); }
    /// The plot as a picture of this size.
    QImage picture(QSize size) const;
    QSize sizeHint() const override { return {640, 180}; }

protected:
    void paintEvent(QPaintEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;

private:
    void paint(QPainter& painter, QSize size) const;

    MeasuredLine line_;
    std::string unit_;
    std::optional<double> cursor_;  ///< distance
    std::function<void(std::optional<double>)> tell_;
};

}  // namespace app
