// Pins, labels and files of markers.
#pragma once

#include <string>

#include <Inventor/SbColor.h>

class SoNode;
class SoSeparator;

namespace app {

class Scene;

/// Gives a drape or a placement the rows and columns of the terrain that it belongs to.
void takeGrid(const Scene& scene, SoNode& node);
/// A pin with its tip on the ground where the group is, as high as suits a ground of this size, and its name above.
void addPin(SoSeparator& group, const SbColor& color, float size, const std::string& name);
/// White text with a dark edge, so high above the ground.
void addLabel(SoSeparator& group, const std::string& text, float height);

}  // namespace app
