// What the height tools show in a scene: the place that was picked, the measured line, markers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Inventor/SbVec2s.h>
#include <Inventor/nodes/SoSeparator.h>

#include "HeightTools.h"
#include "NodePtr.h"
#include "Scene.h"

namespace app {

/// Nodes behind the terrain, in its own separator, so that they stand on the same ground in the same place: SoTerrainDrape and
/// SoTerrainPlacement. None of them can be picked.
class ToolsDrawing {
public:
    /// The scene outlives it.
    explicit ToolsDrawing(Scene& scene);

    /// Puts the nodes behind the terrain that the scene has now. To be called before a frame is drawn; costs nothing where that is
    /// the former one. False when there is no terrain, or the group that holds it draws one child alone.
    bool follow();

    /// Shows nothing.
    void forget();
    void showSpot(const std::optional<Spot>& spot, const std::string& label);
    /// `label`: at the end of the line.
    void showLine(const std::vector<glm::dvec2>& corners, const std::string& label);
    /// A place along the line.
    void showCursor(const std::optional<glm::dvec2>& place);
    void showMarkers(const std::vector<Marker>& markers);

private:
    /// An object that stands on the ground: it begins with an SoTerrainPlacement.
    SoSeparator* standing(glm::dvec2 place) const;
    void addDrape(SoSeparator& group, const std::vector<glm::dvec2>& points, bool asPoints) const;
    SoNode* home() const;
    void leave();

    Scene& scene_;
    NodePtr<SoSeparator> root_;
    NodePtr<SoNode> terrain_;  ///< behind which they are
    NodePtr<SoNode> home_;     ///< that holds them: the terrain's parent, or the list of children of a kit
    SoSeparator* spot_;
    SoSeparator* line_;
    SoSeparator* cursor_;
    SoSeparator* markers_;
    std::vector<glm::dvec2> corners_;
    std::string lineLabel_;
    std::vector<Marker> shownMarkers_;
    std::optional<Spot> shownSpot_;
    std::string spotLabel_;
    std::optional<glm::dvec2> shownCursor_;
};

/// The markers as a scene that can stand behind any terrain node: each a separator with an SoTerrainPlacement, a pin and its name.
std::optional<terrain::Error> writeMarkersScene(const std::string& path, const std::vector<Marker>& markers, float size);
/// Reads what writeMarkersScene() or markersCsv() wrote, by the ending of the name: .iv, or else CSV.
terrain::Result<std::vector<Marker>> readMarkers(const std::string& path);
/// Writes them likewise. `size`: of the ground, for the pins of an .iv file.
std::optional<terrain::Error> writeMarkers(const std::string& path, const std::vector<Marker>& markers, float size);

/// The place on the ground under a pixel of the picture, counted from its lower left corner; nothing where no ground is seen.
std::optional<glm::dvec2> placeUnder(const Scene& scene, const SbVec2s& pixel, const SbVec2s& pictureSize);

}  // namespace app
