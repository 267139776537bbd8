#include "lod/DrapeView.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/Box.h"

namespace terrain {

namespace {

constexpr float kTolerancePixels = 0.2f;
/// Beside the error: what is left out of the line, and what rasterisation rounds.
constexpr double kMorePixels = 1.5 * kTolerancePixels;

/// Height at a fraction of the way between two vertices is linear, so a difference of raises is one of heights.
double between(double a, double b, double weight) {
    return a + weight * (b - a);
}

}  // namespace

DrapeView::DrapeView(const DrapedLines& lines, const View& view, const glm::dmat4& localFromFrame, const DrapeSettings& settings)
    : lines_(lines), settings_(settings), screen_(view, localFromFrame, ErrorDirection::Vertical), localFromFrame_(localFromFrame),
      clipFromFrame_(view.clipFromLocal * localFromFrame), frameFromClip_(glm::inverse(clipFromFrame_)),
      rows_(glm::transpose(clipFromFrame_)), halfViewport_(view.viewportPixels * 0.5) {}

double DrapeView::raise(const glm::dvec3& place) const {
    const glm::dvec4 clip = clipFromFrame_ * glm::dvec4(place, 1.0);
    const glm::dvec4 up = clipFromFrame_[2];
    if (!(clip.w > 0.0)) return 0.0;
    // A height d shows as d * shown / (w + d * up.w), see ScreenSpace.
    const double pixels = double(settings_.pixelError) + kMorePixels;
    const double shown = glm::length(halfViewport_ * (glm::dvec2(up) - glm::dvec2(clip) * (up.w / clip.w)));
    const double free = shown - pixels * up.w;
    // The ground's top, and somewhat more for the sake of rounding.
    double most = std::max(0.0, double(settings_.top) - place.z) + 1e-5 * (std::fabs(double(settings_.top)) + std::fabs(place.z));
    if (up.w + up.z < 0.0) most = std::min(most, 0.9 * std::max(0.0, clip.w + clip.z) / -(up.w + up.z));
    return free > 0.0 ? std::min(most, pixels * clip.w / free) : most;
}

/// Difference in depth (normalised device coordinates) that brings the vertex as near as the ground half a width beside it.
double DrapeView::towardsViewer(const DrapedLines::Vertex& vertex, const glm::dvec4& clip) const {
    const glm::dvec3 device = glm::dvec3(clip) / clip.w;
    glm::dvec3 change[2];
    for (int axis = 0; axis < 2; ++axis) {
        const glm::dvec4 tangent = clipFromFrame_[axis] + clipFromFrame_[2] * double(vertex.gradient[axis]);
        change[axis] = (glm::dvec3(tangent) - device * tangent.w) / clip.w;
        change[axis].x *= halfViewport_.x;
        change[axis].y *= halfViewport_.y;
    }
    const double area = change[0].x * change[1].y - change[0].y * change[1].x;
    const glm::dvec2 slope((change[0].z * change[1].y - change[1].z * change[0].y) / area,
                           (change[1].z * change[0].x - change[0].z * change[1].x) / area);
    // Ground that is seen edge on would bring it to the eye: a twentieth of the way is the most.
    constexpr double kMost = 0.05;
    const glm::dvec3 depthRow(rows_[2]), wRow(rows_[3]);
    const double square = glm::dot(wRow, wRow);
    const double ratio = square > 0.0 ? glm::dot(depthRow, wRow) / square : 0.0;
    const double most = square > 0.0 ? std::fabs(rows_[2].w - ratio * rows_[3].w) * kMost / clip.w : kMost;
    constexpr double kLeast = 1.0 / (1 << 21);  // some steps of a depth buffer of 24 bits
    const double wanted = glm::length(slope) * (0.5 * settings_.width + 0.5);
    return std::max(kLeast, wanted < most ? wanted : most);
}

void DrapeView::add(std::uint32_t vertex, std::uint32_t run, DrapeSelection& selection) const {
    const DrapedLines::Vertex& v = lines_.vertices()[vertex];
    glm::dvec3 place(v.position);
    place.z += raise(place);
    const glm::dvec4 clip = clipFromFrame_ * glm::dvec4(place, 1.0);
    if (clip.w > 0.0 && clip.z + clip.w > 0.0) {
        const double nearest = -clip.w * (1.0 - 1e-4);
        const double depth = std::max(std::min(nearest, clip.z), clip.z - towardsViewer(v, clip) * clip.w);
        const glm::dvec4 moved = frameFromClip_ * glm::dvec4(clip.x, clip.y, depth, clip.w);
        if (moved.w > 0.0) place = glm::dvec3(moved) / moved.w;
    }
    selection.positions.emplace_back(position(place));
    selection.vertices.push_back({vertex, run});
    ++selection.counts.back();
}

void DrapeView::refine(std::uint32_t first, std::uint32_t last, std::uint32_t run, DrapeSelection& selection) const {
    if (last - first < 2) return;
    const std::uint32_t middle = DrapedLines::halfway(first, last);
    const DrapedLines::Vertex &a = lines_.vertices()[first], &b = lines_.vertices()[last], &m = lines_.vertices()[middle];
    Box box = boxBetween(glm::min(a.position, b.position), glm::max(a.position, b.position));
    const double raiseA = raise(a.position), raiseB = raise(b.position), raiseM = raise(m.position);
    const double weight = double(m.along - a.along) / double(b.along - a.along);
    const float error = lines_.deviation(middle) + float(std::fabs(raiseM - between(raiseA, raiseB, weight)));
    const float reach = lines_.deviation(middle) + float(std::max({raiseA, raiseB, raiseM}));
    box.half.z += reach;
    if (screen_.isOutside(box)) return;
    // An error of 0 has no direction to be seen from.
    if (screen_.screenError(std::max(error, 1e-30f), box) <= kTolerancePixels) return;
    refine(first, middle, run, selection);
    add(middle, run, selection);
    refine(middle, last, run, selection);
}

void DrapeView::addRun(const DrapedLines::Run& run, std::uint32_t number, DrapeSelection& selection) const {
    const std::uint32_t last = run.first + run.count - 1;
    if (!run.continues || settings_.separateSegments || selection.counts.empty()) {
        selection.firsts.push_back(int(selection.positions.size()));
        selection.counts.push_back(0);
        add(run.first, number, selection);
    }
    if (run.count < 2) return;
    refine(run.first, last, number, selection);
    add(last, number, selection);
}

DrapeSelection DrapeView::select() const {
    DrapeSelection selection;
    for (std::uint32_t i = 0; i < lines_.runs().size(); ++i) addRun(lines_.runs()[i], i, selection);
    return selection;
}

}  // namespace terrain
