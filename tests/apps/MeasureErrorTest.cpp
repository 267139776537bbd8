// The error meter finds errors that are known in advance.
#include "MeasureError.h"

#include <gtest/gtest.h>

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoDB.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoOrthographicCamera.h>
#include <Inventor/nodes/SoQuadMesh.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoTranslation.h>

#include "gl/HeadlessContext.h"

namespace {

using app::ErrorSample;
using app::TerrainGrid;

TEST(ErrorSample, KnowsRmsQuantileAndMaximum)
{
    ErrorSample sample;
    for (int i = 1; i <= 1000; ++i) sample.add(i * 0.01);
    EXPECT_EQ(sample.samples(), 1000u);
    EXPECT_DOUBLE_EQ(sample.maximum(), 10.0);
    EXPECT_NEAR(sample.quantile(0.5), 5.01, 0.002);
    EXPECT_NEAR(sample.rms(), std::sqrt(1001.0 * 2001.0 / 6.0) * 0.01, 1e-6);
}

TEST(ErrorSample, MergedIsAsIfAddedTogether)
{
    ErrorSample all, one, two;
    for (int i = 0; i < 100; ++i) {
        all.add(i * 0.1);
        (i % 3 ? one : two).add(i * 0.1);
    }
    one.merge(two);
    EXPECT_DOUBLE_EQ(one.rms(), all.rms());
    EXPECT_EQ(one.quantile(0.9), all.quantile(0.9));
    EXPECT_EQ(one.maximum(), all.maximum());
    EXPECT_EQ(one.samples(), all.samples());
}

TEST(ErrorSample, GrossErrorsKeepTheirMaximum)
{
    ErrorSample sample;
    sample.add(1e9);
    EXPECT_EQ(sample.maximum(), 1e9);
    EXPECT_EQ(sample.quantile(0.999), 1e9);
}

// A wavy grid seen from the side by an orthographic camera: 100 pixels a unit of height.
class ErrorMeterTest : public testing::Test {
protected:
    static constexpr int side = 200;

    void SetUp() override
    {
        auto context = terrain::HeadlessContext::create(side, side);
        if (!context) GTEST_SKIP() << context.error().message();
        context_ = std::move(context).value();
        SoDB::init();
        SoInteraction::init();
        terrain::HeightMap map{33, 17, {}, {0, 0}, {1, 1}, ""};
        for (int i = 0; i < 33 * 17; ++i) map.heights.push_back(0.2f * std::sin(float(i)));
        auto grid = app::placeGrid(terrain::makeMapSource(std::move(map)).value(), glm::dvec2(1.0 / 32.0, 1.0 / 16.0), 1.0);
        ASSERT_TRUE(grid);
        grid_ = std::move(grid).value();
        root_ = app::NodePtr(new SoSeparator);
        auto* camera = new SoOrthographicCamera;
        camera->position.setValue(0.5f, -2.0f, 0.0f);
        camera->orientation.setValue(SbVec3f(1, 0, 0), float(M_PI / 2));
        camera->height = 2.0f;
        camera->nearDistance = 0.1f;
        camera->farDistance = 5.0f;
        coordinates_ = app::makeCoordinates(grid_);
        mesh_ = app::makeQuadMesh(grid_);
        for (SoNode* node : {static_cast<SoNode*>(camera), static_cast<SoNode*>(coordinates_), static_cast<SoNode*>(mesh_)}) {
            root_->addChild(node);
        }
    }

    ErrorSample measure()
    {
        app::ErrorMeter meter(grid_, root_.get(), mesh_);
        SoGLRenderAction action(SbViewportRegion(side, side));
        action.setCacheContext(SoGLCacheContextElement::getUniqueCacheContext());
        glEnable(GL_DEPTH_TEST);
        const auto result = meter.measure([&] {
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            action.apply(root_.get());
        });
        EXPECT_TRUE(result) << (result ? "" : result.error().message());
        return result ? result.value() : ErrorSample();
    }

    std::unique_ptr<terrain::HeadlessContext> context_;
    TerrainGrid grid_;
    app::NodePtr<SoSeparator> root_;
    SoCoordinate3* coordinates_ = nullptr;
    SoQuadMesh* mesh_ = nullptr;
};

TEST_F(ErrorMeterTest, FullDetailHasNoError)
{
    const ErrorSample sample = measure();
    EXPECT_EQ(sample.samples(), 31u * 15u) << "every sample but those of the border";
    EXPECT_EQ(sample.missing, 0u);
    EXPECT_LT(sample.maximum(), 0.01);
}

TEST_F(ErrorMeterTest, OneMovedSampleShowsItsPixels)
{
    SbVec3f* points = coordinates_->point.startEditing();
    points[8 * 33 + 16][2] += 0.03f;
    coordinates_->point.finishEditing();
    EXPECT_NEAR(measure().maximum(), 3.0, 0.01);
}

TEST_F(ErrorMeterTest, MovedSurfaceShowsTheSameErrorEverywhere)
{
    SbVec3f* points = coordinates_->point.startEditing();
    for (int i = 0; i < coordinates_->point.getNum(); ++i) points[i][2] -= 0.002f;
    coordinates_->point.finishEditing();
    const ErrorSample sample = measure();
    EXPECT_NEAR(sample.rms(), 0.2, 0.005);
    EXPECT_NEAR(sample.maximum(), 0.2, 0.01);
}

TEST_F(ErrorMeterTest, SamplesWithoutSurfaceAreCounted)
{
    mesh_->verticesPerColumn = 9;
    const ErrorSample sample = measure();
    EXPECT_EQ(sample.samples() + sample.missing, 31u * 15u);
    EXPECT_GE(sample.missing, 31u * 7u);
}

TEST_F(ErrorMeterTest, SceneIsAsBeforeAfterwards)
{
    const int children = root_->getNumChildren();
    GLint before = 0, after = 0;
    context_->bindFramebuffer();
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
    measure();
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &after);
    EXPECT_EQ(root_->getNumChildren(), children);
    EXPECT_EQ(after, before);
}

}  // namespace
