// The ground of a scene, for the height tools.
#pragma once

#include "HeightTools.h"
#include "Scene.h"

namespace app {

/// Asks the terrain that the scene has at the moment of the question: after a switch of the algorithm it is the same ground.
class SceneGround : public Ground {
public:
    /// The scene outlives it.
    explicit SceneGround(const Scene& scene) : scene_(scene) {}

    std::optional<Surface> at(glm::dvec2 place) const override;
    Lattice lattice() const override;

private:
    const Scene& scene_;
};

}  // namespace app
