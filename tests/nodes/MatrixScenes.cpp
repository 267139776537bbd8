// Transforms, groups and cameras of the matrix.
#include "Matrix.h"

#include <Inventor/SoRenderManager.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/actions/SoSearchAction.h>

namespace test::matrix {

namespace {

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
    return {"Transforms and groups", "scenes", rows};
}

namespace {

/// Draws as viewers do.
Property managed(const std::string& name, const std::function<void(SoRenderManager&)>& set, Measure measure, double tolerance) {
    Property property{.name = "SoRenderManager: " + name, .tolerance = {0.5, tolerance, 3.0}, .measure = measure};
    property.draw = [set](Stage& stage, SoSeparator* root) {
        stage.clear();
        glEnable(GL_DEPTH_TEST);
        SoRenderManager manager;
        manager.setGLRenderAction(&stage.action());
        manager.setViewportRegion(stage.region());
        manager.setWindowSize(stage.region().getWindowSize());
        manager.setBackgroundColor(SbColor4f(1.0f, 0.0f, 1.0f, 1.0f));
        manager.setAutoClipping(SoRenderManager::NO_AUTO_CLIPPING);
        manager.setSceneGraph(root);
        manager.setCamera(static_cast<SoCamera*>(root->getChild(0)));
        manager.setDoubleBuffer(FALSE);
        set(manager);
        manager.render(TRUE, TRUE);
        return stage.picture();
    };
    return property;
}

}  // namespace

Group cameras() {
    std::vector<Property> rows;
    const std::string placed = "nearDistance 1 farDistance 400 position 10 -20 50 orientation 1 0 0 0.9 ";
    rows.push_back({.name = "PerspectiveCamera", .view = "PerspectiveCamera { heightAngle 1.2 " + placed + "}"});
    rows.push_back({.name = "OrthographicCamera", .view = "OrthographicCamera { height 60 " + placed + "}"});
    rows.push_back({.name = "FrustumCamera", .view = "FrustumCamera { left -0.8 right 0.4 top 0.4 bottom -0.6 " + placed + "}"});
    rows.push_back({.name = "Camera: viewportMapping LEAVE_ALONE, aspectRatio",
                    .view = "PerspectiveCamera { viewportMapping LEAVE_ALONE aspectRatio 2.5 " + placed + "}"});
    Property part{.name = "SbViewportRegion: part of the window"};
    part.draw = [](Stage& stage, SoSeparator* root) {
        SbViewportRegion region(stage.region());
        region.setViewportPixels(SbVec2s(40, 20), SbVec2s(100, 80));
        stage.clear();
        stage.draw(root, &region);
        return stage.picture();
    };
    rows.push_back(part);
    for (const auto& [name, mode] : {std::pair{"LEFT_VIEW", SoCamera::LEFT_VIEW}, {"RIGHT_VIEW", SoCamera::RIGHT_VIEW}}) {
        Property stereo{.name = std::string("SoCamera::setStereoMode ") + name};
        stereo.draw = [mode](Stage& stage, SoSeparator* root) {
            auto* camera = static_cast<SoCamera*>(root->getChild(0));
            camera->setStereoMode(mode);
            camera->setStereoAdjustment(8.0f);
            return stage.render(root);
        };
        rows.push_back(stereo);
    }
    const auto stereo = [](SoRenderManager::StereoMode mode) {
        return [mode](SoRenderManager& manager) {
            manager.setStereoMode(mode);
            manager.setStereoOffset(8.0f);
        };
    };
    rows.push_back(managed("ANAGLYPH", stereo(SoRenderManager::ANAGLYPH), Measure::Pixels, 1.0));
    rows.push_back(managed("INTERLEAVED_ROWS", stereo(SoRenderManager::INTERLEAVED_ROWS), Measure::Pixels, 1.0));
    const auto mode = [](SoRenderManager::RenderMode mode) {
        return [mode](SoRenderManager& manager) { manager.setRenderMode(mode); };
    };
    rows.push_back(managed("WIREFRAME", mode(SoRenderManager::WIREFRAME), Measure::Areas, 3.0));
    rows.push_back(managed("POINTS", mode(SoRenderManager::POINTS), Measure::Areas, 3.0));
    rows.push_back(managed("HIDDEN_LINE", mode(SoRenderManager::HIDDEN_LINE), Measure::Areas, 3.0));
    rows.push_back(managed("WIREFRAME_OVERLAY", mode(SoRenderManager::WIREFRAME_OVERLAY), Measure::Areas, 3.0));
    rows.push_back(managed("BOUNDING_BOX", mode(SoRenderManager::BOUNDING_BOX), Measure::Areas, 3.0));
    return {"Cameras and render modes", "cameras", rows};
}

}  // namespace test::matrix
