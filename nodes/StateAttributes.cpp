#include "StateAttributes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <Inventor/actions/SoAction.h>
#include <Inventor/actions/SoPickAction.h>
#include <Inventor/elements/SoGLMultiTextureCoordinateElement.h>
#include <Inventor/elements/SoLazyElement.h>
#include <Inventor/elements/SoMaterialBindingElement.h>
#include <Inventor/elements/SoMultiTextureEnabledElement.h>
#include <Inventor/elements/SoNormalBindingElement.h>
#include <Inventor/elements/SoNormalElement.h>
#include <Inventor/misc/SoState.h>

#include "ElementAccess.h"
#include "FaceNormal.h"
#include "TerrainTextureUse.h"

StateAttributes::StateAttributes(SoAction * action, const terrain::SampleGrid & grid, bool forGL) : grid_(grid)
{
    SoState * state = action->getState();
    if (forGL) needsNormals_ = SoLazyElement::getLightModel(state) != SoLazyElement::BASE_COLOR;
    if (needsNormals_) readNormals(state);
    readMaterials(state);
    readTextures(state, forGL);
}

long StateAttributes::countFor(Binding binding) const
{
    const long columns = grid_.columns(), rows = grid_.rows();
    switch (binding) {
    case PER_ROW: return rows - 1;
    case PER_FACE: return (columns - 1) * (rows - 1);
    case PER_VERTEX: return columns * rows;
    default: return 1;
    }
}

bool StateAttributes::isEnough(const char * what, Binding binding, long found, const char * remedy)
{
    const long expected = countFor(binding);
    if (found >= expected) return true;
    problems_.push_back(std::string(what) + ": expected " + std::to_string(expected) + ", found " + std::to_string(found) + "; " + remedy);
    return false;
}

void StateAttributes::readNormals(SoState * state)
{
    const SoNormalElement * element = SoNormalElement::getInstance(state);
    normalCount_ = element->getNum();
    if (normalCount_ > 0) {
        normals_ = element->getArrayPtr();
        switch (SoNormalBindingElement::get(state)) {
        case SoNormalBindingElement::OVERALL: normalBinding_ = OVERALL; break;
        case SoNormalBindingElement::PER_PART:
        case SoNormalBindingElement::PER_PART_INDEXED: normalBinding_ = PER_ROW; break;
        case SoNormalBindingElement::PER_FACE:
        case SoNormalBindingElement::PER_FACE_INDEXED: normalBinding_ = PER_FACE; break;
        default: normalBinding_ = PER_VERTEX; break;
        }
        if (!isEnough("normals", normalBinding_, normalCount_, "the terrain computes its own")) normalBinding_ = GENERATED;
        mix(element->getNodeId());
    }
    mix(normalBinding_);
    format_.normals = normalBinding_ != OVERALL;
}

void StateAttributes::readMaterials(SoState * state)
{
    lazy_ = SoLazyElement::getInstance(state);
    switch (SoMaterialBindingElement::get(state)) {
    case SoMaterialBindingElement::OVERALL: materialBinding_ = OVERALL; break;
    case SoMaterialBindingElement::PER_PART:
    case SoMaterialBindingElement::PER_PART_INDEXED: materialBinding_ = PER_ROW; break;
    case SoMaterialBindingElement::PER_FACE:
    case SoMaterialBindingElement::PER_FACE_INDEXED: materialBinding_ = PER_FACE; break;
    default: materialBinding_ = PER_VERTEX; break;
    }
    // Material nodes do not act in a pick: there the binding alone says which index a vertex has.
    materialCount_ = state->getAction()->isOfType(SoPickAction::getClassTypeId()) ? std::numeric_limits<int>::max() : lazy_->getNumDiffuse();
    if (materialCount_ <= 1) materialBinding_ = OVERALL;
    isEnough("materials", materialBinding_, materialCount_, "the last one serves for the rest");
    format_.colours = materialBinding_ != OVERALL;
    if (format_.colours) mix(LazyElementAccess::colourId(lazy_));
    mix(materialBinding_);
}

void StateAttributes::readTextures(SoState * state, bool forGL)
{
    textureCoordinates_ = SoMultiTextureCoordinateElement::getInstance(state);
    if (!forGL) return;
    int last = -1;
    const SbBool * enabled = SoMultiTextureEnabledElement::getEnabledUnits(state, last);
    const bool tiled = hasTerrainTexture(state);
    for (int unit = 0; unit <= std::max(last, 0); ++unit) {
        const bool wanted = (enabled && unit <= last && enabled[unit]) || (unit == 0 && tiled);
        if (!wanted) continue;
        const auto type = SoMultiTextureCoordinateElement::getType(state, unit);
        mix(std::uint64_t(type) + std::uint64_t(unit) * 16);
        // GL's own texture coordinate generation needs no coordinates from us.
        if (type == SoMultiTextureCoordinateElement::TEXGEN) continue;
        if (type == SoMultiTextureCoordinateElement::EXPLICIT)
            isEnough("texture coordinates", PER_VERTEX, textureCoordinates_->getNum(unit), "the rest span the terrain");
        format_.textureUnits.push_back(unit);
        if (type == SoMultiTextureCoordinateElement::FUNCTION ||
            (type == SoMultiTextureCoordinateElement::EXPLICIT && textureCoordinates_->getDimension(unit) > 2))
            format_.wideUnits.push_back(unit);
        mix(TextureCoordinateElementAccess::unitId(textureCoordinates_, unit));
    }
}

int StateAttributes::boundIndex(Binding binding, int column, int row, int count) const
{
    std::size_t index = 0;
    if (binding == PER_ROW) index = std::size_t(std::min(row, grid_.rows() - 2));
    if (binding == PER_FACE)
        index = std::size_t(std::min(row, grid_.rows() - 2)) * std::size_t(grid_.columns() - 1) + std::size_t(std::min(column, grid_.columns() - 2));
    if (binding == PER_VERTEX) index = grid_.index(column, row);
    return int(std::min(index, std::size_t(std::max(count - 1, 0))));
}

/// The slopes are those between the valid neighbours on both sides; none where there is no neighbour.
SbVec3f StateAttributes::regularNormal(int column, int row) const
{
    const auto isValid = [this](int c, int r) { return grid_.contains(c, r) && std::isfinite(grid_.height(c, r)); };
    const int left = isValid(column - 1, row) ? column - 1 : column, right = isValid(column + 1, row) ? column + 1 : column;
    const int below = isValid(column, row - 1) ? row - 1 : row, above = isValid(column, row + 1) ? row + 1 : row;
    const glm::dmat4 & local = grid_.localFromFrame();
    const int up = grid_.heightAxis(), along = local[0][(up + 1) % 3] != 0.0 ? (up + 1) % 3 : (up + 2) % 3, across = 3 - up - along;
    double slopes[2] = {0.0, 0.0};
    if (right > left) slopes[0] = double(grid_.height(right, row) - grid_.height(left, row)) / (local[0][along] * (right - left));
    if (above > below) slopes[1] = double(grid_.height(column, above) - grid_.height(column, below)) / (local[1][across] * (above - below));
    const double factor = 1.0 / std::sqrt(1.0 + slopes[0] * slopes[0] + slopes[1] * slopes[1]);
    SbVec3f normal;
    normal[along] = float(-slopes[0] * factor);
    normal[across] = float(-slopes[1] * factor);
    normal[up] = float(factor);
    return normal;
}

SbVec3f StateAttributes::generatedNormal(int column, int row) const
{
    if (grid_.isRegular()) return regularNormal(column, row);
    const glm::vec3 middle = grid_.framePosition(column, row);
    // The last valid neighbours on both sides; a missing one is replaced by the sample itself.
    const auto neighbour = [&](int dc, int dr) {
        const int c = std::clamp(column + dc, 0, grid_.columns() - 1), r = std::clamp(row + dr, 0, grid_.rows() - 1);
        return grid_.isHole(c, r) ? middle : grid_.framePosition(c, r);
    };
    return normalOfDirections(grid_, neighbour(1, 0) - neighbour(-1, 0), neighbour(0, 1) - neighbour(0, -1));
}

SbVec3f StateAttributes::normal(int column, int row) const
{
    if (normalBinding_ == GENERATED) return generatedNormal(column, row);
    return normals_[boundIndex(normalBinding_, column, row, normalCount_)];
}

bool StateAttributes::hasNormalsOfSurface() const
{
    if (!needsNormals_ || normalBinding_ == GENERATED) return true;
    constexpr float kLeastCosine = 0.98f;
    for (int row = 0; row < grid_.rows(); ++row)
        for (int column = 0; column < grid_.columns(); ++column) {
            if (grid_.isHole(column, row)) continue;
            SbVec3f explicitNormal = normal(column, row);
            explicitNormal.normalize();
            if (!(explicitNormal.dot(generatedNormal(column, row)) >= kLeastCosine)) return false;
        }
    return true;
}

SbVec4f StateAttributes::wideTextureCoordinate(int unit, int column, int row) const
{
    const std::size_t index = grid_.index(column, row);
    const auto type = textureCoordinates_->getType(unit);
    if (type == SoMultiTextureCoordinateElement::EXPLICIT && index < std::size_t(textureCoordinates_->getNum(unit)))
        return textureCoordinates_->get4(unit, int(index));
    if (type == SoMultiTextureCoordinateElement::FUNCTION && !grid_.isHole(column, row)) {
        const glm::vec3 p = grid_.position(column, row);
        return textureCoordinates_->get(unit, SbVec3f(p.x, p.y, p.z), normal(column, row));
    }
    return SbVec4f(float(column) / float(grid_.columns() - 1), float(row) / float(grid_.rows() - 1), 0.0f, 1.0f);
}

SbVec2f StateAttributes::textureCoordinate(int unit, int column, int row) const
{
    const SbVec4f four = wideTextureCoordinate(unit, column, row);
    const float q = four[3] != 0.0f ? four[3] : 1.0f;
    return SbVec2f(four[0] / q, four[1] / q);
}

bool StateAttributes::hasTextureFunction(int unit) const
{
    const auto type = textureCoordinates_->getType(unit);
    return type == SoMultiTextureCoordinateElement::FUNCTION || type == SoMultiTextureCoordinateElement::TEXGEN;
}

bool StateAttributes::hasAffineTextureCoordinates(int unit) const
{
    if (textureCoordinates_->getType(unit) != SoMultiTextureCoordinateElement::EXPLICIT) return true;
    const int columns = grid_.columns() - 1, rows = grid_.rows() - 1;
    const SbVec2f origin = textureCoordinate(unit, 0, 0);
    const SbVec2f alongRow = (textureCoordinate(unit, columns, 0) - origin) / float(columns);
    const SbVec2f alongColumn = (textureCoordinate(unit, 0, rows) - origin) / float(rows);
    constexpr float kTolerance = 1e-3f;
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column <= columns; ++column) {
            const SbVec2f off = textureCoordinate(unit, column, row) - (origin + alongRow * float(column) + alongColumn * float(row));
            if (!(std::fabs(off[0]) <= kTolerance && std::fabs(off[1]) <= kTolerance)) return false;
        }
    return true;
}

int StateAttributes::materialIndex(int column, int row) const
{
    return boundIndex(materialBinding_, column, row, materialCount_);
}

int StateAttributes::materialIndex(const Corner & corner) const
{
    const bool ofCell = materialBinding_ == PER_FACE || materialBinding_ == PER_ROW;
    return ofCell ? materialIndex(corner.cellColumn, corner.cellRow) : materialIndex(corner.column, corner.row);
}

int StateAttributes::normalIndex(const Corner & corner) const
{
    const bool ofCell = normalBinding_ == PER_FACE || normalBinding_ == PER_ROW;
    if (normalBinding_ == GENERATED) return int(grid_.index(corner.column, corner.row));
    return ofCell ? boundIndex(normalBinding_, corner.cellColumn, corner.cellRow, normalCount_)
                  : boundIndex(normalBinding_, corner.column, corner.row, normalCount_);
}

SbVec3f StateAttributes::normal(const Corner & corner) const
{
    return normalBinding_ == GENERATED ? generatedNormal(corner.column, corner.row) : normals_[normalIndex(corner)];
}

SbVec4f StateAttributes::textureCoordinates(const Corner & corner) const
{
    return wideTextureCoordinate(0, corner.column, corner.row);
}

void StateAttributes::prefetch(std::uint32_t sample) const
{
    if (format_.normals && normalBinding_ == PER_VERTEX) __builtin_prefetch(&normals_[sample]);
    for (const int unit : format_.textureUnits)
        if (textureCoordinates_->getDimension(unit) == 2 && std::int64_t(sample) < textureCoordinates_->getNum(unit))
            __builtin_prefetch(&textureCoordinates_->getArrayPtr2(unit)[sample]);
}

void StateAttributes::writeColour(int column, int row, std::uint8_t * out) const
{
    const int index = materialIndex(column, row);
    const int transparencies = lazy_->getNumTransparencies();
    std::uint32_t rgba;
    if (lazy_->isPacked()) {
        rgba = lazy_->getPackedPointer()[index];
    } else {
        const float transparency = transparencies > 0 ? lazy_->getTransparencyPointer()[std::min(index, transparencies - 1)] : 0.0f;
        rgba = lazy_->getDiffusePointer()[index].getPackedValue(transparency);
    }
    const std::uint8_t bytes[4] = {std::uint8_t(rgba >> 24), std::uint8_t(rgba >> 16), std::uint8_t(rgba >> 8), std::uint8_t(rgba)};
    std::memcpy(out, bytes, sizeof bytes);
}

void StateAttributes::writeCoordinate(int unit, const SbVec4f & coordinate, std::uint8_t *& out) const
{
    const std::size_t bytes = (format_.isWide(unit) ? 4 : 2) * sizeof(float);
    std::memcpy(out, coordinate.getValue(), bytes);
    out += bytes;
}

void StateAttributes::write(std::uint32_t sample, std::uint8_t * out) const
{
    const int column = int(sample % std::uint32_t(grid_.columns())), row = int(sample / std::uint32_t(grid_.columns()));
    if (format_.normals) {
        const SbVec3f n = normal(column, row);
        std::memcpy(out, n.getValue(), 3 * sizeof(float));
        out += 3 * sizeof(float);
    }
    if (format_.colours) {
        writeColour(column, row, out);
        out += 4;
    }
    for (const int unit : format_.textureUnits) writeCoordinate(unit, wideTextureCoordinate(unit, column, row), out);
}

void StateAttributes::writeAt(glm::vec2 place, std::uint32_t nearest, std::uint8_t * out) const
{
    const int column = std::clamp(int(place.x), 0, grid_.columns() - 2), row = std::clamp(int(place.y), 0, grid_.rows() - 2);
    const float u = place.x - float(column), v = place.y - float(row);
    const bool upper = u + v > 1.0f;
    struct Corner {
        int column, row;
        float weight;
    };
    const Corner corners[3] = {upper ? Corner{column + 1, row + 1, u + v - 1.0f} : Corner{column, row, 1.0f - u - v},
                               {column + 1, row, upper ? 1.0f - v : u}, {column, row + 1, upper ? 1.0f - u : v}};
    if (format_.normals) {
        SbVec3f sum(0.0f, 0.0f, 0.0f);
        const bool smooth = normalBinding_ == PER_VERTEX || normalBinding_ == GENERATED;
        // Corners without weight may be holes.
        for (const Corner & corner : corners)
            if (corner.weight > 0.0f) sum += normal(smooth ? corner.column : column, smooth ? corner.row : row) * corner.weight;
        sum.normalize();
        std::memcpy(out, sum.getValue(), 3 * sizeof(float));
        out += 3 * sizeof(float);
    }
    if (format_.colours) {
        writeColour(int(nearest % std::uint32_t(grid_.columns())), int(nearest / std::uint32_t(grid_.columns())), out);
        out += 4;
    }
    for (const int unit : format_.textureUnits) {
        SbVec4f sum(0.0f, 0.0f, 0.0f, 0.0f);
        for (const Corner & corner : corners)
            if (corner.weight > 0.0f) sum += wideTextureCoordinate(unit, corner.column, corner.row) * corner.weight;
        writeCoordinate(unit, sum, out);
    }
}
