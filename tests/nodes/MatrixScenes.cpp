// Transforms and groups of the matrix.
#include "Matrix.h"

#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/actions/SoSearchAction.h>

namespace test::matrix {

namespace {

/// The ground's samples in UTM zone 17, a unit a metre.
std::string geoCoordinates() {
    std::string text = "GeoCoordinate { geoSystem [ \"UTM\", \"Z17\" ] point [ ";
    for (const SbVec3f& p : ground().points)
        text += std::to_string(500000.0 + double(p[0])) + ' ' + std::to_string(4600000.0 + double(p[1])) + ' ' +
                std::to_string(1.5f * p[2]) + ", ";
    return text + "] }\n";
}

Property around(const std::string& name, const std::string& iv) {
    return {.name = name, .iv = iv};
}

std::string geo(const std::string& node, const std::string& coordinates) {
    return node + " { geoSystem [ \"UTM\", \"Z17\" ] geoCoords " + coordinates + " ";
}

}  // namespace

Group scenes() {
    std::vector<Property> rows;
    rows.push_back(around(
        "Transform", "Transform { translation 10 5 4 rotation 0 0 1 0.4 scaleFactor 0.8 0.8 0.8 center 32 32 0 }\nUSE GROUND"));
    rows.push_back(around("Scale, not uniform", "Scale { scaleFactor 1 0.7 1.6 }\nUSE GROUND"));
    rows.push_back(around("Scale, mirrored", "Translation { translation 64 0 0 }\nScale { scaleFactor -1 1 1 }\nUSE GROUND"));
    rows.push_back(around("Scale, upside down", "Translation { translation 0 0 16 }\nDirectionalLight { direction 0.3 -0.4 0.8 "
                                                "}\nScale { scaleFactor 1 1 -1 }\nUSE GROUND"));
    rows.push_back(
        around("MatrixTransform, sheared", "MatrixTransform { matrix 1 0 0.2 0  0.3 1 0 0  0 0 1 0  -10 0 0 1 }\nUSE GROUND"));
    rows.push_back(around("Units", "Units { units CENTIMETERS }\nScale { scaleFactor 100 100 60 }\nUSE GROUND"));
    rows.push_back(
        around("ResetTransform",
               "Translation { translation 500 0 0 }\nSeparator { ResetTransform { }\nScale { scaleFactor 1 1 0.6 }\nUSE GROUND }"));
    rows.push_back(around("Switch", "Switch { whichChild 1 Info { } Separator { Scale { scaleFactor 1 1 0.6 } USE GROUND } }"));
    rows.push_back(
        around("LOD", "LOD { range [ 30, 1000 ] Info { } Separator { Scale { scaleFactor 1 1 0.6 } USE GROUND } Info { } }"));
    rows.push_back(around("LevelOfDetail",
                          "LevelOfDetail { screenArea [ 100 ] Separator { Scale { scaleFactor 1 1 0.6 } USE GROUND } Info { } }"));
    rows.push_back(around("Array", "Scale { scaleFactor 0.5 0.5 0.5 }\nArray { numElements1 2 numElements2 2 separation1 64 0 0 "
                                   "separation2 0 64 0 USE GROUND }"));
    rows.push_back(around(
        "MultipleCopy",
        "MultipleCopy { matrix [ 0.5 0 0 0 0 0.5 0 0 0 0 0.5 0 0 0 0 1, 0.5 0 0 0 0 0.5 0 0 0 0 1 0 32 20 0 1 ] USE GROUND }"));
    rows.push_back(
        around("Several uses with other materials",
               "Separator { Material { diffuseColor 1 0.5 0.1 } Scale { scaleFactor 0.5 1 1 } USE GROUND }\nSeparator { Material { "
               "diffuseColor 0.1 0.5 1 } Translation { translation 32 0 0 } Scale { scaleFactor 0.5 1 1 } USE GROUND }"));
    rows.push_back(around("Annotation", "Annotation { USE GROUND }\nSeparator { Material { diffuseColor 0.9 0.3 0.1 } Translation "
                                        "{ translation 32 32 10 } Cube { width 60 height 60 depth 10 } }"));
    rows.push_back(
        around("Selection, LocateHighlight", "Selection { LocateHighlight { Scale { scaleFactor 1 1 0.6 } USE GROUND } }"));
    Property cached =
        around("Separator: renderCaching ON, several frames",
               "Separator { renderCaching ON Separator { renderCaching ON Scale { scaleFactor 1 1 0.6 } USE GROUND } }");
    cached.draw = [](Stage& stage, SoSeparator* root) {
        auto* camera = static_cast<SoCamera*>(root->getChild(0));
        const SbVec3f at = camera->position.getValue();
        for (int frame = 0; frame < 3; ++frame) stage.render(root);
        camera->position = at + SbVec3f(10.0f, 5.0f, 20.0f);
        for (int frame = 0; frame < 3; ++frame) stage.render(root);
        return stage.render(root);
    };
    rows.push_back(cached);
    rows.push_back(around("Separator: renderCulling ON",
                          "Separator { renderCulling ON Translation { translation 300 0 0 } USE GROUND "
                          "}\nSeparator { renderCulling ON Scale { scaleFactor 1 1 0.6 } USE GROUND }"));
    rows.push_back(around("Translation far away", "Scale { scaleFactor 1 1 0.6 }\nTranslation { translation 200000 -100000 0 "
                                                  "}\nTranslation { translation -200000 100000 0 }\nUSE GROUND"));
    rows.push_back(around("GeoOrigin, GeoSeparator", geo("GeoOrigin", "846889 4313850 0") + "}\n" +
                                                         geo("GeoSeparator", "846889 4313850 0") +
                                                         "Scale { scaleFactor 1 1 0.6 } USE GROUND }"));
    rows.push_back(around("GeoOrigin, GeoSeparator at another place",
                          geo("GeoOrigin", "500000 4600000 0") + "}\n" + geo("GeoSeparator", "500020 4600010 5") + "USE GROUND }"));
    rows.push_back({.name = "GeoOrigin, GeoCoordinate",
                    .iv = geoCoordinates(),
                    .base = "Scale { scaleFactor 1 1 0.6 }\n" + geo("GeoOrigin", "500000 4600000 0") + "}",
                    .arrays = "the coordinates are no regular grid"});
    Property path =
        around("SoGLRenderAction applied to a path", "Separator { Scale { scaleFactor 1 1 0.6 } USE GROUND }\nSeparator { "
                                                     "Translation { translation 32 32 20 } Cube { width 20 height 20 depth 20 } }");
    path.draw = [](Stage& stage, SoSeparator* root) {
        SoSearchAction search;
        search.setType(SoShape::getClassTypeId());
        search.apply(root);
        stage.clear();
        stage.action().setViewportRegion(stage.region());
        stage.action().apply(search.getPath());
        return stage.picture();
    };
    rows.push_back(path);
    return {
        "Transforms and groups",
        "scenes",
        rows,
        {{"Camera under a transform", "Coin 4.0.0's viewing matrix is then not the one that it draws with; nodes that choose by "
                                      "the view cull wrongly. A GeoSeparator around the ground stands for large coordinates"},
         {"SceneTexture2", "not part of the test: a picture takes Coin 4.0.0 minutes in a context without a window"}}};
}

}  // namespace test::matrix
