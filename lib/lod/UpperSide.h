// Whether a camera stands above a height field, so that the undersides of its triangles can't be seen.
#pragma once

#include "base/View.h"
#include "height/SampleGrid.h"
#include "lod/BoxPyramid.h"

namespace terrain {

/// True only if whatever ray of the view first meets a height field meets it from above. A ray that begins above the ground and
/// within its borders can come to be below it only through it, and no straight line leaves a rectangle and returns. So the near
/// rectangle of the view volume must lie within the borders and above all samples below it, and the field must have no holes. The
/// surface that is drawn may be off by an error on screen: that is nothing near the eye, where a ray begins.
bool showsUpperSideOnly(const SampleGrid& grid, const BoxPyramid& boxes, const View& view);

}  // namespace terrain
