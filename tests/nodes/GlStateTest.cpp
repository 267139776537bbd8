// What the nodes leave behind in GL: nothing.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/nodes/SoCallback.h>
#include <Inventor/nodes/SoCube.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoMaterialBinding.h>
#include <Inventor/nodes/SoTranslation.h>

#include <SoTerrain/SoROAMTerrain.h>

using namespace test;
using terrain::Image;

namespace {

Surface hills() { return surfaceOf(fractalMap(65, 65, 20.0)); }

/// GL state that a shape must give back.
std::vector<GLint> stateNow() {
    std::vector<GLint> state;
    for (const GLenum what : {GL_ARRAY_BUFFER_BINDING, GL_ELEMENT_ARRAY_BUFFER_BINDING, GL_CURRENT_PROGRAM, GL_ACTIVE_TEXTURE, GL_CLIENT_ACTIVE_TEXTURE,
                              GL_VERTEX_ARRAY_BINDING, GL_MATRIX_MODE, GL_DEPTH_FUNC, GL_POLYGON_MODE, GL_FRONT_FACE, GL_CULL_FACE_MODE, GL_SHADE_MODEL,
                              GL_MODELVIEW_STACK_DEPTH, GL_ATTRIB_STACK_DEPTH, GL_CLIENT_ATTRIB_STACK_DEPTH, GL_UNPACK_ALIGNMENT}) {
        GLint values[4] = {0, 0, 0, 0};
        glGetIntegerv(what, values);
        state.push_back(values[0]);
    }
    for (const GLenum what : {GL_VERTEX_ARRAY, GL_NORMAL_ARRAY, GL_COLOR_ARRAY, GL_INDEX_ARRAY, GL_EDGE_FLAG_ARRAY, GL_PRIMITIVE_RESTART, GL_CULL_FACE,
                              GL_NORMALIZE, GL_RESCALE_NORMAL, GL_BLEND, GL_DEPTH_TEST, GL_LIGHTING, GL_COLOR_MATERIAL})
        state.push_back(glIsEnabled(what));
    GLint active = 0;
    glGetIntegerv(GL_CLIENT_ACTIVE_TEXTURE, &active);
    for (GLenum unit = GL_TEXTURE0; unit < GL_TEXTURE4; ++unit) {
        glClientActiveTexture(unit);
        state.push_back(glIsEnabled(GL_TEXTURE_COORD_ARRAY));
    }
    glClientActiveTexture(GLenum(active));
    return state;
}

/// Records the state where it stands in the scene.
SoCallback* recorder(std::vector<GLint>& into) {
    auto* node = new SoCallback;
    node->setCallback([](void* closure, SoAction* action) {
        if (action->isOfType(SoGLRenderAction::getClassTypeId())) *static_cast<std::vector<GLint>*>(closure) = stateNow();
    }, &into);
    return node;
}

void addColours(SoGroup* group) {
    auto* material = new SoMaterial;
    for (int i = 0; i < 65 * 65; ++i) material->diffuseColor.set1Value(i, SbColor(float(i % 65) / 64.0f, 1.0f, 0.0f));
    group->addChild(material);
    auto* binding = new SoMaterialBinding;
    binding->value = SoMaterialBinding::PER_VERTEX;
    group->addChild(binding);
}

/// Buffers that exist in the current context, by name.
int liveBuffers() {
    int count = 0;
    for (GLuint name = 1; name < 4096; ++name) count += glIsBuffer(name) ? 1 : 0;
    return count;
}

std::uint32_t generatedPrimitives(Stage& stage, SoNode* root) {
    GLuint query = 0, count = 0;
    stage.makeCurrent();
    glGenQueries(1, &query);
    glBeginQuery(GL_PRIMITIVES_GENERATED, query);
    stage.draw(root);
    glEndQuery(GL_PRIMITIVES_GENERATED);
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &count);
    glDeleteQueries(1, &query);
    return count;
}

class GlState : public testing::TestWithParam<Kind> {};

}  // namespace

TEST_P(GlState, AfterTheNodeIsWhatItWasBefore) {
    for (const bool coloured : {false, true}) {
        std::vector<GLint> before, after;
        const auto root = sceneOf(GetParam(), hills(), {.coordinatesOnUnit = 1}, [&](SoSeparator* group) {
            addTexture(group);
            addTexture(group, 3, 1);
            if (coloured) addColours(group);
        });
        auto* dressed = static_cast<SoSeparator*>(root->getChild(2));
        auto* group = static_cast<SoSeparator*>(dressed->getChild(dressed->getNumChildren() - 1));
        // Draws once, so that lazy state has been sent when the recorders look.
        const int shape = group->getNumChildren() - 1;
        group->insertChild(group->getChild(shape), shape);
        group->insertChild(recorder(before), shape + 1);
        group->addChild(recorder(after));
        auto* node = static_cast<SoTerrainShape*>(group->getChild(shape));
        Stage stage;
        for (const int view : {SoTerrainShape::NONE, SoTerrainShape::LEVELS, SoTerrainShape::ERRORS})
            for (const bool edges : {false, true})
                for (int frame = 0; frame < 2; ++frame) {
                    node->debugView = view;
                    node->wireframeOverlay = edges;
                    node->freeze = node->frozenFrustum = edges && view == SoTerrainShape::ERRORS;
                    stage.render(root.get());
                    EXPECT_EQ(after, before) << "frame " << frame << ", colours " << coloured << ", debugView " << view << ", edges " << edges;
                }
    }
}

TEST_P(GlState, LetsACubeAfterTheNodeLookAsItDoesAlone) {
    for (const bool coloured : {false, true}) {
        Stage stage;
        const auto cubeAfter = [&](bool withTerrain) {
            const auto root = sceneOf(GetParam(), hills());
            auto* dressed = static_cast<SoSeparator*>(root->getChild(2));
            auto* group = static_cast<SoSeparator*>(dressed->getChild(0));
            if (coloured) {
                auto* colours = new SoGroup;
                addColours(colours);
                group->insertChild(colours, 0);
            }
            if (!withTerrain) group->removeChild(group->getNumChildren() - 1);
            auto* move = new SoTranslation;
            // In front of the camera, over all of the picture's middle.
            move->translation = SbVec3f(5.0f, -5.0f, 40.0f);
            group->addChild(move);
            auto* cube = new SoCube;
            cube->width = cube->height = cube->depth = 12.0f;
            group->addChild(cube);
            return stage.render(root.get());
        };
        const Image alone = cubeAfter(false), after = cubeAfter(true);
        savePicture("cube_after_" + identifierOf(GetParam()) + (coloured ? "_coloured" : ""), {alone, after});
        const Difference found = compare(alone, after);
        EXPECT_EQ(found.onlyFirst, 0);
        EXPECT_GT(found.covered, 500);
        EXPECT_EQ(found.largest, 0) << "coloured " << coloured;
    }
}

TEST_P(GlState, CountsTheTrianglesThatGlGets) {
    const auto root = sceneOf(GetParam(), hills());
    Stage stage;
    // The first frame of a clipmap draws into its textures as well.
    stage.render(root.get());
    stage.clear();
    const std::uint32_t counted = generatedPrimitives(stage, root.get());
    EXPECT_EQ(terrainIn(root.get())->getStatistics().triangles, counted);
    EXPECT_GT(counted, 0u);
    if (GetParam() == Kind::BruteForce) {
        EXPECT_EQ(counted, 64u * 64u * 2u);
    }
}

INSTANTIATE_TEST_SUITE_P(, GlState, testing::ValuesIn(kOurKinds),
                         [](const auto& info) { return "Of" + identifierOf(info.param); });

TEST(TriangleCount, IsAHardBudget) {
    const Surface surface = surfaceOf(fractalMap(257, 257, 60.0));
    for (const int budget : {8, 100, 1000, 5000}) {
        const auto root = sceneOf(Kind::Roam, surface, {.pixelError = 0.1f}, unlitTexture);
        auto* node = static_cast<SoROAMTerrain*>(terrainIn(root.get()));
        node->triangleCount = budget;
        Stage stage;
        for (int frame = 0; frame < 4; ++frame) {
            root->replaceChild(0, cameraAt(SbVec3f(-20.0f + 60.0f * float(frame), 20.0f, 70.0f), SbVec3f(128.0f, 128.0f, 20.0f), 1.0f, 600.0f));
            stage.clear();
            const std::uint32_t counted = generatedPrimitives(stage, root.get());
            EXPECT_LE(counted, std::uint32_t(budget)) << "frame " << frame;
            EXPECT_EQ(node->getStatistics().triangles, counted);
            EXPECT_GT(counted, std::uint32_t(budget) / 8) << "frame " << frame;
            EXPECT_GT(node->getStatistics().errorPixels, 0.1) << "a bound that was not reached is told";
        }
    }
}

TEST(Buffers, OfANodeThatIsGoneAreDeletedByTheNextFrame) {
    for (const Kind kind : kOurKinds) {
        Stage stage;
        Ref<SoSeparator> empty(new SoSeparator);
        stage.render(empty.get());
        const int before = liveBuffers();
        {
            const auto root = sceneOf(kind, hills());
            stage.render(root.get());
            EXPECT_GT(liveBuffers(), before);
            EXPECT_GT(terrainIn(root.get())->getStatistics().bufferBytes, 0u);
        }
        stage.render(empty.get());
        EXPECT_EQ(liveBuffers(), before) << nameOf(kind);
    }
}

TEST(Buffers, DoNotPileUpOverManyNodes) {
    Stage stage(64, 48);
    Ref<SoSeparator> empty(new SoSeparator);
    stage.render(empty.get());
    const int before = liveBuffers();
    for (int round = 0; round < 50; ++round) stage.render(sceneOf(round % 2 ? Kind::Roam : Kind::BruteForce, hills(), {}, [](SoSeparator* group) { addColours(group); }).get());
    stage.render(empty.get());
    EXPECT_EQ(liveBuffers(), before);
}

TEST(Buffers, OfTwoContextsGoWithTheirOwn) {
    for (const Kind kind : kOurKinds)
        for (const bool firstGoesFirst : {true, false})
            for (const bool nodeGoesFirst : {true, false}) {
                auto first = std::make_unique<Stage>(), second = std::make_unique<Stage>();
                auto root = sceneOf(kind, hills(), {}, unlitTexture);
                const Image a = first->render(root.get()), b = second->render(root.get());
                EXPECT_EQ(a.pixels, b.pixels);
                if (nodeGoesFirst) root = Ref<SoSeparator>();
                (firstGoesFirst ? first : second).reset();
                auto& left = firstGoesFirst ? second : first;
                if (!nodeGoesFirst) {
                    EXPECT_EQ(left->render(root.get()).pixels, a.pixels) << nameOf(kind);
                    EXPECT_GT(liveBuffers(), 0);
                    root = Ref<SoSeparator>();
                }
                Ref<SoSeparator> empty(new SoSeparator);
                left->render(empty.get());
                EXPECT_EQ(liveBuffers(), 0) << nameOf(kind);
            }
}

TEST(Buffers, OfTheSecondContextHaveTheirOwnMesh) {
    const auto root = sceneOf(Kind::Roam, hills(), {}, unlitTexture);
    Stage first, second;
    const Image alone = first.render(root.get());
    for (int frame = 0; frame < 3; ++frame) {
        EXPECT_EQ(second.render(root.get()).pixels, alone.pixels);
        EXPECT_EQ(first.render(root.get()).pixels, alone.pixels);
    }
}
