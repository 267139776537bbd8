#include "PerfPanel.h"

#include <algorithm>
#include <cmath>

using terrain::OverlayColor;
using terrain::OverlayQuads;
using terrain::OverlayVertex;

namespace {

constexpr OverlayColor kWhite = {255, 255, 255, 255}, kDim = {200, 200, 200, 255}, kLine = {255, 255, 255, 50};
constexpr float kMargin = 3.0f;

}  // namespace

void PerfLayout::fit()
{
    for (const int axis : {0, 1}) size[axis] = std::floor(std::max(1.0f, std::min(size[axis], viewport[axis] - 2.0f * std::fabs(position[axis]))));
    position = {std::floor(position.x), std::floor(position.y)};
}

glm::vec2 PerfLayout::cornerOf(int graph) const
{
    const glm::vec2 step = size + gap;
    const int fitting = std::max(1, int((viewport.x - 2.0f * std::fabs(position.x) + gap) / step.x));
    const int inRow = columns > 0 ? columns : fitting;
    const glm::vec2 before = glm::vec2(float(graph % inRow), float(graph / inRow)) * step;
    // From the right or from above the first graph is the outermost one, too.
    glm::vec2 corner = position + before;
    for (const int axis : {0, 1})
        if (position[axis] < 0.0f) corner[axis] = viewport[axis] + position[axis] - size[axis] - before[axis];
    return corner;
}

PerfGraphPicture::PerfGraphPicture(const PerfLayout & layout, int graph)
    : low_(layout.cornerOf(graph)), high_(low_ + layout.size), curveTop_(high_.y), textScale_(layout.textScale)
{
    const float line = float(terrain::kGlyphHeight * textScale_);
    if (layout.size.y >= 1.5f * line) curveTop_ -= line + 1.0f;
}

float PerfGraphPicture::heightOf(double value, const PerfPlot & plot) const
{
    // Half a pixel: lines run through the middle of pixels.
    const double share = (value - plot.bottom()) / (plot.top() - plot.bottom());
    return low_.y + 0.5f + float(std::clamp(share, 0.0, 1.0)) * (curveTop_ - low_.y - 1.0f);
}

void PerfGraphPicture::addGround(OverlayQuads & to, const PerfPlot & plot, const PerfGraphStyle & style) const
{
    to.addRectangle(low_, high_, style.ground);
    const auto addLine = [&](double value) {
        const float y = std::floor(heightOf(value, plot));
        to.addRectangle({low_.x, y}, {high_.x, y + float(textScale_)}, kLine);
    };
    addLine(plot.top());
    addLine(0.5 * (plot.top() + plot.bottom()));
    if (plot.bottom() < 0.0) addLine(0.0);
}

void PerfGraphPicture::addText(OverlayQuads & to, const PerfPlot & plot, const PerfGraphStyle & style, const std::string & name,
                               const std::string & unit) const
{
    const float glyph = float(terrain::kGlyphWidth * textScale_), line = float(terrain::kGlyphHeight * textScale_);
    const float left = low_.x + kMargin, right = high_.x - kMargin;
    if (high_.y - low_.y < line) return;
    const auto cut = [glyph](const std::string & text, float width) { return terrain::glyphsOf(text).substr(0, std::size_t(std::max(0.0f, width / glyph))); };
    const auto value = cut(shortNumber(plot.value(), unit), right - left);
    const float valueLeft = right - float(value.size()) * glyph;
    to.addText({valueLeft, high_.y - line}, value, kWhite, textScale_);
    to.addText({left, high_.y - line}, cut(name, valueLeft - glyph - left), style.color, textScale_);
    const float room = curveTop_ - low_.y;
    if (curveTop_ == high_.y || room < line + 2.0f) return;
    to.addText({left, curveTop_ - line - 1.0f}, cut(roundNumber(plot.top(), unit), right - left), kDim, textScale_);
    if (plot.bottom() < 0.0 && room >= 2.0f * line + 4.0f)
        to.addText({left, low_.y + 1.0f}, cut(roundNumber(plot.bottom(), unit), right - left), kDim, textScale_);
}

int PerfGraphPicture::addCurve(std::vector<OverlayVertex> & curves, const PerfPlot & plot, const OverlayColor & color) const
{
    const std::size_t verticesPerPoint = plot.isCondensed() ? 2 : 1;
    const std::size_t before = curves.size(), count = plot.size() * verticesPerPoint;
    curves.resize(before + count);
    const float step = (high_.x - low_.x - 1.0f) / float(std::max<std::size_t>(plot.capacity(), 2) - 1);
    const float factor = float(1.0 / (plot.top() - plot.bottom())), bottom = float(plot.bottom());
    const float height = curveTop_ - low_.y - 1.0f, y = low_.y + 0.5f;
    // The latest stands at the right.
    float x = low_.x + 0.5f + step * float(plot.capacity() - plot.size());
    OverlayVertex * out = curves.data() + before;
    plot.visit([&](const PerfPlot::Point & point) {
        *out++ = {x, y + std::clamp((point.low - bottom) * factor, 0.0f, 1.0f) * height, 0, 0, color};
        if (verticesPerPoint == 2) *out++ = {x, y + std::clamp((point.high - bottom) * factor, 0.0f, 1.0f) * height, 0, 0, color};
        x += step;
    });
    return int(count);
}
