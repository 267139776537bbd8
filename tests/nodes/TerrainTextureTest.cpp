// SoTerrainTexture on each of our nodes, against SoTexture2 with the same image.
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "Scenes.h"

#include <gtest/gtest.h>

#ifdef HAVE_OPENIMAGEIO

#include <cmath>
#include <filesystem>
#include <fstream>

#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/nodes/SoCallback.h>
#include <Inventor/nodes/SoComplexity.h>
#include <Inventor/nodes/SoEnvironment.h>
#include <Inventor/nodes/SoFragmentShader.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoShaderProgram.h>
#include <Inventor/nodes/SoTexture2.h>
#include <Inventor/nodes/SoTexture2Transform.h>
#include <Inventor/nodes/SoTextureCoordinatePlane.h>
#include <Inventor/nodes/SoTextureUnit.h>
#include <Inventor/nodes/SoTranslation.h>
#include <Inventor/nodes/SoVertexShader.h>

#include <SoTerrain/SoTerrainTexture.h>

#include "../height/TiledFiles.h"

using namespace test;
using terrain::Image;
using terrain::test::levelsOf;
using terrain::test::placeTexel;
using terrain::test::Texels;
using terrain::test::texelsOf;
using terrain::test::writeLevels;

namespace {

Surface hills(int side = 65) { return surfaceOf(fractalMap(side, side, 20.0)); }

/// Colours that tell top from bottom and left from right, in waves of 40 texels.
Texels waves(int width, int height) {
    return texelsOf(width, height, 3, [=](int x, int y, int c) {
        if (c == 0) return std::uint8_t(30 + 200 * x / width);
        if (c == 2) return std::uint8_t(30 + 200 * y / height);
        return std::uint8_t(128.0 + 100.0 * std::sin(x * 0.15) * std::sin(y * 0.15));
    });
}

SoTerrainTexture* tiled(const std::string& path, int clipSize = 64) {
    auto* node = new SoTerrainTexture;
    node->filename = path.c_str();
    node->clipSize = clipSize;
    return node;
}

/// The same image as Coin has it: rows from the bottom.
SoTexture2* plain(const Texels& image) {
    std::vector<std::uint8_t> turned;
    for (int y = image.height - 1; y >= 0; --y) turned.insert(turned.end(), image.at(0, y), image.at(0, y) + image.width * 3);
    auto* node = new SoTexture2;
    node->image.setValue(SbVec2s(short(image.width), short(image.height)), 3, turned.data());
    node->wrapS = node->wrapT = SoTexture2::CLAMP;
    return node;
}

/// White ground, and textures filtered between levels.
void addGround(SoGroup* group) {
    auto* material = new SoMaterial;
    material->diffuseColor = SbColor(1.0f, 1.0f, 1.0f);
    group->addChild(material);
    auto* complexity = new SoComplexity;
    complexity->textureQuality = 0.85f;
    group->addChild(complexity);
}

class TerrainTexture : public testing::TestWithParam<Kind> {
protected:
    std::string file(const Texels& image, const std::string& name = "image.tif") {
        const std::string path = folder_.file(name);
        writeLevels(path, levelsOf(image), 64);
        return path;
    }

    /// Both pictures, and whether they are alike.
    void expectLikeTexture2(const std::string& name, const Texels& image, const ShapeOptions& options, const Dressing& dress, double mean) {
        const std::string path = file(image);
        Stage stage;
        const auto draw = [&](bool ours) {
            return stage.render(sceneOf(GetParam(), hills(), options, [&](SoSeparator* group) {
                addGround(group);
                group->addChild(ours ? static_cast<SoNode*>(tiled(path)) : plain(image));
                if (dress) dress(group);
            }).get());
        };
        const Image reference = draw(false), found = draw(true);
        savePicture("terrain_texture_" + name + "_" + identifierOf(GetParam()), {reference, found});
        expectAlike(reference, found, mean, nameOf(GetParam()));
        EXPECT_GT(compare(reference, stage.render(sceneOf(GetParam(), hills(), options, addGround).get())).mean, 5 * mean) << "the texture is there";
    }

    TemporaryFolder folder_;
};

int liveTextures() {
    int count = 0;
    for (GLuint name = 1; name < 4096; ++name) count += glIsTexture(name) ? 1 : 0;
    return count;
}

int livePrograms() {
    int count = 0;
    for (GLuint name = 1; name < 4096; ++name) count += glIsProgram(name) ? 1 : 0;
    return count;
}

}  // namespace

TEST_P(TerrainTexture, LooksAsATexture2OfTheSameImage) {
    expectLikeTexture2("small", waves(60, 50), {}, {}, 2.0);
    expectLikeTexture2("windows", waves(512, 512), {}, {}, 3.0);
}

TEST_P(TerrainTexture, FollowsTextureCoordinates) {
    expectLikeTexture2("coordinates", waves(256, 256), {.coordinatesOnUnit = 0}, {}, 3.0);
    expectLikeTexture2("plane", waves(256, 256), {}, [](SoSeparator* group) {
        auto* plane = new SoTextureCoordinatePlane;
        plane->directionS = SbVec3f(0.01f, 0.003f, 0.0f);
        plane->directionT = SbVec3f(0.0f, 0.012f, 0.004f);
        group->addChild(plane);
    }, 3.0);
    expectLikeTexture2("transform", waves(256, 256), {}, [](SoSeparator* group) {
        auto* transform = new SoTexture2Transform;
        transform->rotation = 0.4f;
        transform->scaleFactor = SbVec2f(0.6f, 0.6f);
        transform->center = SbVec2f(0.5f, 0.5f);
        group->addChild(transform);
    }, 3.0);
}

TEST_P(TerrainTexture, IsSeenThroughFog) {
    for (const auto type : {SoEnvironment::HAZE, SoEnvironment::FOG, SoEnvironment::SMOKE})
        expectLikeTexture2("fog", waves(256, 256), {}, [type](SoSeparator* group) {
            auto* fog = new SoEnvironment;
            fog->fogType = type;
            fog->fogColor = SbColor(0.9f, 0.9f, 1.0f);
            fog->fogVisibility = 150.0f;
            group->addChild(fog);
        }, 3.0);
}

TEST_P(TerrainTexture, LeavesGlAsItWas) {
    const std::string path = file(waves(256, 256));
    Stage stage;
    // A shape with a texture of Coin's, after the terrain, which is drawn out of sight.
    const auto root = sceneOf(Kind::QuadMesh, hills(), {}, [](SoSeparator* group) { addTexture(group); });
    const Image alone = stage.render(root.get());
    const auto before = sceneOf(GetParam(), hills(), {}, [&](SoSeparator* group) {
        auto* aside = new SoTranslation;
        aside->translation = SbVec3f(0.0f, -1000.0f, 0.0f);
        group->addChild(aside);
        group->addChild(tiled(path));
    });
    terrainIn(before.get())->frustumCulling = FALSE;
    auto* look = new SoCallback;
    look->setCallback([](void*, SoAction* action) {
        if (!action->isOfType(SoGLRenderAction::getClassTypeId())) return;
        GLint program = -1, active = -1, array = -1;
        glGetIntegerv(GL_CURRENT_PROGRAM, &program);
        glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
        glGetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &array);
        EXPECT_EQ(program, 0);
        EXPECT_EQ(active, GL_TEXTURE0);
        EXPECT_EQ(array, 0);
    });
    root->insertChild(look, 2);
    root->insertChild(before->getChild(2), 2);
    for (int frame = 0; frame < 2; ++frame) {
        EXPECT_EQ(stage.render(root.get()).pixels, alone.pixels) << "frame " << frame;
        EXPECT_GT(terrainIn(root->getChild(2))->getStatistics().triangles, 0u);
    }
}

INSTANTIATE_TEST_SUITE_P(, TerrainTexture, testing::ValuesIn(kOurKinds), [](const auto& info) { return "On" + identifierOf(info.param); });

class TerrainTextureScene : public TerrainTexture {};
INSTANTIATE_TEST_SUITE_P(, TerrainTextureScene, testing::Values(Kind::Roam), [](const auto&) { return "Roam"; });

TEST_P(TerrainTextureScene, ReplacesTheTexture2BeforeItAndIsReplacedByOneAfterIt) {
    const Texels image = waves(128, 128);
    const std::string path = file(image);
    Stage stage;
    const auto draw = [&](const Dressing& dress) {
        return stage.render(sceneOf(GetParam(), hills(), {}, [&](SoSeparator* group) {
            addGround(group);
            dress(group);
        }).get());
    };
    const Image ours = draw([&](SoSeparator* group) { group->addChild(tiled(path)); });
    const Image theirs = draw([](SoSeparator* group) { addTexture(group); });
    EXPECT_GT(compare(ours, theirs).mean, 20.0);
    EXPECT_EQ(draw([&](SoSeparator* group) {
        addTexture(group);
        group->addChild(tiled(path));
    }).pixels, ours.pixels);
    EXPECT_EQ(draw([&](SoSeparator* group) {
        group->addChild(tiled(path));
        addTexture(group);
    }).pixels, theirs.pixels);
    const Image bare = draw([](SoSeparator*) {});
    EXPECT_EQ(draw([&](SoSeparator* group) {
        group->addChild(tiled(path));
        group->addChild(new SoTexture2);
    }).pixels, bare.pixels) << "an empty SoTexture2 is no texture";
    EXPECT_EQ(draw([&](SoSeparator* group) {
        auto* inner = new SoSeparator;
        inner->addChild(tiled(path));
        group->addChild(inner);
    }).pixels, bare.pixels) << "not beyond its separator";
    EXPECT_EQ(draw([&](SoSeparator* group) {
        group->addChild(tiled(path));
        auto* off = new SoComplexity;
        off->textureQuality = 0.0f;
        group->addChild(off);
    }).pixels, bare.pixels) << "no textures at quality 0";
}

TEST_P(TerrainTextureScene, ComesToRestAtTheSamePictureWhateverTheBudget) {
    const std::string path = file(waves(1024, 1024));
    Stage stage;
    auto* texture = tiled(path);
    const auto root = sceneOf(GetParam(), hills(), {}, [&](SoSeparator* group) {
        addGround(group);
        group->addChild(texture);
    }, cameraAt({10, 10, 30}, {20, 20, 10}, 0.5f, 300.0f));
    stage.render(root.get());
    EXPECT_TRUE(terrainIn(root.get())->getStatistics().converged) << "the first frame is complete";
    texture->updateBudget = 2000;
    // A jump to the other end.
    root->replaceChild(0, cameraAt({55, 55, 30}, {45, 45, 10}, 0.5f, 300.0f));
    int frames = 0;
    Image picture;
    do {
        picture = stage.render(root.get());
        const auto statistics = terrainIn(root.get())->getStatistics();
        EXPECT_EQ(SoDB::getSensorManager()->isDelaySensorPending() != FALSE, !statistics.converged) << "frame " << frames;
        SoDB::getSensorManager()->processDelayQueue(TRUE);
    } while (!terrainIn(root.get())->getStatistics().converged && ++frames < 200);
    EXPECT_GT(frames, 1);
    EXPECT_LT(frames, 200);
    Stage fresh;
    EXPECT_EQ(picture.pixels, fresh.render(root.get()).pixels);
}

/// debugView LOADING: violet where texels are on their way, and nowhere once all are there.
TEST_P(TerrainTextureScene, IsShownWhileItIsLoading) {
    const std::string path = file(waves(1024, 1024));
    Stage stage;
    auto* texture = tiled(path);
    const auto root = sceneOf(GetParam(), hills(), {}, [&](SoSeparator* group) {
        addGround(group);
        group->addChild(texture);
    }, cameraAt({10, 10, 30}, {20, 20, 10}, 0.5f, 300.0f));
    terrainIn(root.get())->debugView = SoTerrainShape::LOADING;
    const auto violet = [&] {
        const Image picture = stage.render(root.get());
        int count = 0;
        for (std::size_t i = 0; i < picture.pixels.size(); i += 3) count += picture.pixels[i + 1] > 0 && 10 * picture.pixels[i + 2] > 14 * picture.pixels[i + 1];
        return count;
    };
    EXPECT_EQ(violet(), 0) << "the first frame is complete";
    texture->updateBudget = 2000;
    root->replaceChild(0, cameraAt({55, 55, 30}, {45, 45, 10}, 0.5f, 300.0f));
    EXPECT_GT(violet(), 1000);
    for (int frame = 0; frame < 200 && !terrainIn(root.get())->getStatistics().converged; ++frame) violet();
    EXPECT_EQ(violet(), 0) << "at rest";
}

TEST_P(TerrainTextureScene, TakesTexturesByItsClipSizeAndReportsThem) {
    const std::string path = file(waves(2048, 2048));
    Stage stage;
    auto* texture = tiled(path, 128);
    texture->memoryBudget = 2;
    const auto root = sceneOf(GetParam(), hills(), {}, [&](SoSeparator* group) { group->addChild(texture); });
    stage.render(root.get());
    const auto first = terrainIn(root.get())->getStatistics();
    EXPECT_GT(first.bufferBytes, 5u * 128 * 128 * 4);
    EXPECT_LT(first.bufferBytes, 6u * 128 * 128 * 4 + (1u << 20));
    EXPECT_LT(first.memoryBytes, (2u << 20) + (1u << 20));
    texture->clipSize = 256;
    stage.render(root.get());
    EXPECT_GT(terrainIn(root.get())->getStatistics().bufferBytes, 4u * 256 * 256 * 4);
}

TEST_P(TerrainTextureScene, GoesWithItsContextAndWithItsNode) {
    const std::string path = file(waves(300, 300));
    const auto scene = [&] {
        return sceneOf(GetParam(), hills(), {}, [&](SoSeparator* group) {
            addGround(group);
            group->addChild(tiled(path));
        });
    };
    Ref<SoSeparator> empty(new SoSeparator);
    for (const bool nodeGoesFirst : {true, false}) {
        auto first = std::make_unique<Stage>(), second = std::make_unique<Stage>();
        first->makeCurrent();
        ASSERT_EQ(liveTextures(), 0);
        auto root = scene();
        const Image a = first->render(root.get()), b = second->render(root.get());
        EXPECT_EQ(a.pixels, b.pixels);
        EXPECT_EQ(first->render(root.get()).pixels, a.pixels);
        EXPECT_EQ(liveTextures(), 2);
        EXPECT_EQ(livePrograms(), 1);
        if (nodeGoesFirst) root = Ref<SoSeparator>();
        first.reset();
        if (!nodeGoesFirst) {
            EXPECT_EQ(second->render(root.get()).pixels, a.pixels);
            root = Ref<SoSeparator>();
        }
        second->render(empty.get());
        EXPECT_EQ(liveTextures(), 0);
        EXPECT_EQ(livePrograms(), 1) << "programs stay until their context goes";
    }
}

TEST_P(TerrainTextureScene, SaysOnceWhatIsWrongAndDrawsTheGround) {
    Stage stage;
    const Image bare = stage.render(sceneOf(GetParam(), hills(), {}, addGround).get());
    writeLevels(folder_.file("cut.png"), {texelsOf(300, 300, 3, placeTexel)}, 0);
    std::filesystem::resize_file(folder_.file("cut.png"), std::filesystem::file_size(folder_.file("cut.png")) / 2);
    std::ofstream(folder_.file("text.tif")) << "no image";
    for (const char* name : {"absent.tif", "text.tif", "cut.png"}) {
        Messages messages;
        auto* texture = tiled(folder_.file(name));
        const auto root = sceneOf(GetParam(), hills(), {}, [&](SoSeparator* group) {
            addGround(group);
            group->addChild(texture);
        });
        for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(stage.render(root.get()).pixels, bare.pixels) << name << " frame " << frame;
        ASSERT_EQ(messages.all().size(), 1u) << messages.text();
        EXPECT_NE(messages.text().find(folder_.file(name) + ": expected "), std::string::npos) << messages.text();
        EXPECT_NE(messages.text().find(", found "), std::string::npos) << messages.text();
    }
}

TEST_P(TerrainTextureScene, TakesTheNearestValuesForBadOnes) {
    Stage stage;
    Messages messages;
    auto* texture = tiled(file(waves(200, 200)), 100);
    texture->updateBudget = -1;
    texture->memoryBudget = 0;
    const auto root = sceneOf(GetParam(), hills(), {}, [&](SoSeparator* group) { group->addChild(texture); });
    for (int frame = 0; frame < 2; ++frame) stage.render(root.get());
    ASSERT_EQ(messages.all().size(), 3u) << messages.text();
    EXPECT_NE(messages.text().find("clipSize: expected a power of two from 64 to 8192, found 100; 128 is taken"), std::string::npos) << messages.text();
    EXPECT_NE(messages.text().find("updateBudget: expected 0 or more, found -1"), std::string::npos) << messages.text();
    EXPECT_NE(messages.text().find("memoryBudget: expected 1 or more, found 0"), std::string::npos) << messages.text();
    messages.clear();
    texture->clipSize = 128;
    texture->updateBudget = 0;
    texture->memoryBudget = 1;
    stage.render(root.get());
    EXPECT_TRUE(messages.all().empty()) << messages.text();
}

TEST_P(TerrainTextureScene, LeavesAShaderProgramOfTheSceneAlone) {
    Stage stage;
    const std::string path = file(waves(200, 200));
    const auto draw = [&](bool withTexture) {
        return stage.render(sceneOf(GetParam(), hills(), {}, [&](SoSeparator* group) {
            addGround(group);
            if (withTexture) group->addChild(tiled(path));
            auto* program = new SoShaderProgram;
            auto* fragment = new SoFragmentShader;
            fragment->sourceType = SoShaderObject::GLSL_PROGRAM;
            fragment->sourceProgram = "void main() { gl_FragColor = vec4(gl_FragCoord.xy / 400.0, 0.5, 1.0); }\n";
            program->shaderObject.set1Value(0, fragment);
            group->addChild(program);
        }).get());
    };
    const Image alone = draw(false);
    Messages messages;
    EXPECT_EQ(draw(true).pixels, alone.pixels);
    ASSERT_EQ(messages.all().size(), 1u) << messages.text();
    EXPECT_NE(messages.text().find("found an SoShaderProgram"), std::string::npos) << messages.text();
}

TEST_P(TerrainTextureScene, OnAnotherUnitSaysThatItIsNotDrawn) {
    Stage stage;
    Messages messages;
    const std::string path = file(waves(200, 200));
    const auto root = sceneOf(GetParam(), hills(), {}, [&](SoSeparator* group) {
        auto* unit = new SoTextureUnit;
        unit->unit = 1;
        group->addChild(unit);
        group->addChild(tiled(path));
        group->addChild(new SoTextureUnit);
    });
    for (int frame = 0; frame < 2; ++frame) stage.render(root.get());
    ASSERT_EQ(messages.all().size(), 1u) << messages.text();
    EXPECT_NE(messages.text().find("expected texture unit 0, found unit 1"), std::string::npos) << messages.text();
}

TEST_P(TerrainTextureScene, IsFoundNextToTheFileThatNamesIt) {
    file(waves(128, 128), "ground.tif");
    std::ofstream(folder_.file("scene.iv")) << "#Inventor V2.1 ascii\nSeparator { DEF t SoTerrainTexture { filename \"ground.tif\" clipSize 64 } }\n";
    SoInput in;
    ASSERT_TRUE(in.openFile(folder_.file("scene.iv").c_str()));
    const Ref<SoSeparator> root(SoDB::readAll(&in));
    ASSERT_TRUE(root.get());
    in.closeFile();
    auto* texture = static_cast<SoTerrainTexture*>(root->getChild(0));
    EXPECT_TRUE(texture->isLoaded());
    const Ref<SoTerrainTexture> copy(static_cast<SoTerrainTexture*>(texture->copy()));
    EXPECT_TRUE(copy->isLoaded());
    EXPECT_EQ(copy->clipSize.getValue(), 64);
}

#endif
