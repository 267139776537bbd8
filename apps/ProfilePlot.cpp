#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include "ProfilePlot.h"

#include <algorithm>
#include <cmath>

#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>

namespace app {

namespace {

const QColor groundColor(196, 178, 140), edgeColor(96, 76, 40), gridColor(214, 214, 214), inkColor(48, 48, 48),
    cursorColor(200, 30, 20);
constexpr int gap = 6;
constexpr int tickPixels = 70;  // about so far apart

// 1, 2 or 5 times a power of ten, at least this large.
double roundStep(double least) {
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= least) return factor * power;
    return 10.0 * power;
}

QString tickText(double value, double step) {
    return QString::number(std::fabs(value) < 0.5 * step ? 0.0 : value, 'f', std::max(0, int(std::ceil(-std::log10(step) - 1e-9))));
}

// What the plot shows, and where.
struct Frame {
    QRectF area;
    double length = 1.0, low = 0.0, high = 1.0;

    Frame(const MeasuredLine& line, QSize size, const QFontMetrics& font) {
        length = line.horizontal;
        low = line.lowest.value_or(0.0);
        high = line.highest.value_or(1.0);
        // Level ground is a line in the middle, not a division by zero.
        const double least = std::max(1e-6 * length, 1e-12), spare = std::max(0.08 * (high - low), 0.5 * least);
        low -= spare;
        high += spare;
        const int left = font.horizontalAdvance("-00000.000") + gap, below = 2 * font.height() + gap, above = font.height() + gap;
        area = QRectF(left, above, std::max(10, size.width() - left - 3 * gap), std::max(10, size.height() - above - below));
    }
    double x(double distance) const { return area.left() + area.width() * distance / length; }
    double y(double height) const { return area.bottom() - area.height() * (height - low) / (high - low); }
};

void paintGrid(QPainter& painter, const Frame& frame, const QString& unit) {
    const QFontMetrics font = painter.fontMetrics();
    const double across = roundStep(frame.length * tickPixels / frame.area.width());
    const double up = roundStep((frame.high - frame.low) * 0.35 * tickPixels / frame.area.height());
    for (double d = 0.0; d <= frame.length * (1.0 + 1e-9); d += across) {
        painter.setPen(gridColor);
        painter.drawLine(QPointF(frame.x(d), frame.area.top()), QPointF(frame.x(d), frame.area.bottom()));
        painter.setPen(inkColor);
        const QRectF place(frame.x(d) - tickPixels, frame.area.bottom() + 2, 2 * tickPixels, font.height());
        painter.drawText(place, Qt::AlignHCenter, tickText(d, across));
    }
    for (double h = std::ceil(frame.low / up) * up; h <= frame.high; h += up) {
        painter.setPen(gridColor);
        painter.drawLine(QPointF(frame.area.left(), frame.y(h)), QPointF(frame.area.right(), frame.y(h)));
        painter.setPen(inkColor);
        const QRectF place(0.0, frame.y(h) - 0.5 * font.height(), frame.area.left() - gap, font.height());
        painter.drawText(place, Qt::AlignRight | Qt::AlignVCenter, tickText(h, up));
    }
    const QString brackets = unit.isEmpty() ? QString() : " [" + unit + "]";
    painter.drawText(QRectF(frame.area.left(), frame.area.bottom() + font.height() + 2, frame.area.width(), font.height()),
                     Qt::AlignHCenter, "distance" + brackets);
    painter.drawText(QPointF(gap, font.ascent() + 2), "height" + brackets);
}

// One piece of ground: from one point without height to the next.
void paintGround(QPainter& painter, const Frame& frame, const std::vector<ProfilePoint>& points) {
    for (std::size_t i = 0; i < points.size();) {
        if (!points[i].height) {
            ++i;
            continue;
        }
        QPolygonF edge;
        for (; i < points.size() && points[i].height; ++i) edge << QPointF(frame.x(points[i].distance), frame.y(*points[i].height));
        QPolygonF body = edge;
        body << QPointF(edge.last().x(), frame.area.bottom()) << QPointF(edge.first().x(), frame.area.bottom());
        painter.setPen(Qt::NoPen);
        painter.setBrush(groundColor);
        painter.drawPolygon(body);
        painter.setPen(QPen(edgeColor, 1.5));
        painter.drawPolyline(edge);
    }
}

}  // namespace

ProfilePlot::ProfilePlot(QWidget* parent) : QWidget(parent) {
    setMouseTracking(true);
    setMinimumSize(240, 110);
    setObjectName("profile-plot");
}

void ProfilePlot::setLine(const MeasuredLine& line, const std::string& unit) {
    line_ = line;
    unit_ = unit;
    cursor_.reset();
    update();
}

QImage ProfilePlot::picture(QSize size) const {
    QImage image(size, QImage::Format_RGB32);
    QPainter painter(&image);
    paint(painter, size);
    return image;
}

void ProfilePlot::paint(QPainter& painter, QSize size) const {
    painter.fillRect(QRect(QPoint(0, 0), size), Qt::white);
    painter.setRenderHint(QPainter::Antialiasing);
    if (!line_.hasGround()) {
        painter.setPen(inkColor);
        painter.drawText(QRect(QPoint(0, 0), size), Qt::AlignCenter,
                         line_.corners.size() < 2 ? "Measure a line: Tools > Measure a line, then click two or more places"
                                                  : "There is no ground under the line");
        return;
    }
    const Frame frame(line_, size, painter.fontMetrics());
    const QString unit = QString::fromStdString(unit_);
    paintGrid(painter, frame, unit);
    paintGround(painter, frame, line_.points);
    painter.setPen(inkColor);
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(frame.area);
    if (!cursor_) return;
    painter.setPen(QPen(cursorColor, 1.0));
    painter.drawLine(QPointF(frame.x(*cursor_), frame.area.top()), QPointF(frame.x(*cursor_), frame.area.bottom()));
    const auto height = line_.heightAt(*cursor_);
    if (height) painter.drawEllipse(QPointF(frame.x(*cursor_), frame.y(*height)), 3.0, 3.0);
    const double digits = frame.length / frame.area.width();
    const QString after = unit.isEmpty() ? unit : " " + unit;
    const QString tall =
        height ? "height " + tickText(*height, (frame.high - frame.low) / frame.area.height()) + after : "no ground";
    const QString words = tickText(*cursor_, digits) + after + ": " + tall;
    painter.drawText(QRectF(frame.area.left(), 0.0, frame.area.width(), frame.area.top()), Qt::AlignRight | Qt::AlignVCenter,
                     words);
}

void ProfilePlot::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    paint(painter, size());
}

void ProfilePlot::mouseMoveEvent(QMouseEvent* event) {
    if (!line_.hasGround()) return;
    const Frame frame(line_, size(), fontMetrics());
    cursor_ = std::clamp((event->localPos().x() - frame.area.left()) / frame.area.width(), 0.0, 1.0) * frame.length;
    if (tell_) tell_(cursor_);
    update();
}

void ProfilePlot::leaveEvent(QEvent*) {
    cursor_.reset();
    if (tell_) tell_(cursor_);
    update();
}

}  // namespace app

#endif
