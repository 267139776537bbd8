// Cameras, render modes and stereo of the matrix.
#include "Matrix.h"

#include <tuple>

#include <gtest/gtest.h>

#include <Inventor/SoRenderManager.h>
#include <Inventor/actions/SoGLRenderAction.h>

namespace test::matrix {

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

/// Into four samples a pixel.
terrain::Image drawMultisampled(Stage& stage, SoSeparator* root) {
    stage.clear();
    GLint target = 0;
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &target);
    const SbVec2s size = stage.region().getWindowSize();
    GLuint framebuffer = 0, buffers[2] = {0, 0};
    glGenFramebuffers(1, &framebuffer);
    glGenRenderbuffers(2, buffers);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    const auto attach = [size](GLuint buffer, GLenum format, GLenum attachment) {
        glBindRenderbuffer(GL_RENDERBUFFER, buffer);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, 4, format, size[0], size[1]);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
    };
    attach(buffers[0], GL_RGBA8, GL_COLOR_ATTACHMENT0);
    attach(buffers[1], GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
    EXPECT_EQ(glCheckFramebufferStatus(GL_FRAMEBUFFER), GLenum(GL_FRAMEBUFFER_COMPLETE));
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    stage.action().setViewportRegion(stage.region());
    stage.action().apply(root);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, GLuint(target));
    glBlitFramebuffer(0, 0, size[0], size[1], 0, 0, size[0], size[1], GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, GLuint(target));
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteRenderbuffers(2, buffers);
    return stage.picture();
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
    Property samples{
        .name = "Multisampling", .tolerance = {0.5, 3.0, 3.0}, .base = "DrawStyle { style LINES }", .measure = Measure::Areas};
    samples.draw = drawMultisampled;
    rows.push_back(samples);
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
    return {"Cameras and render modes",
            "cameras",
            rows,
            {{"SoGLRenderAction::setNumPasses", "needs an accumulation buffer, which contexts without a window do not have: Coin "
                                                "draws one pass and says so. A pass is the camera moved by less than a pixel"}}};
}

}  // namespace test::matrix
