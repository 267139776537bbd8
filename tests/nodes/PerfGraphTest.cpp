// SoPerfGraph shows what was counted, where it should, and touches nothing else.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <regex>

#include <Inventor/nodes/SoCube.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoOrthographicCamera.h>
#include <Inventor/nodes/SoTranslation.h>

#include <SoTerrain/SoPerfGraph.h>

#include "PerfCounters.h"
#include "PerfPlot.h"
#include "gl/Overlay.h"

using namespace test;

namespace {

/// What GL can be asked for of what a graph might change.
std::vector<GLfloat> allGlState() {
    std::vector<GLfloat> state;
    for (const GLenum what :
         {GL_ALPHA_TEST, GL_CULL_FACE, GL_DEPTH_TEST, GL_FOG, GL_LIGHTING, GL_STENCIL_TEST, GL_LINE_STIPPLE, GL_LINE_SMOOTH, GL_POLYGON_STIPPLE,
          GL_POLYGON_SMOOTH, GL_COLOR_LOGIC_OP, GL_POLYGON_OFFSET_FILL, GL_CLIP_PLANE0, GL_CLIP_PLANE1, GL_CLIP_PLANE2, GL_CLIP_PLANE3, GL_COLOR_SUM,
          GL_BLEND, GL_VERTEX_PROGRAM_ARB, GL_FRAGMENT_PROGRAM_ARB, GL_VERTEX_ARRAY, GL_COLOR_ARRAY, GL_NORMAL_ARRAY, GL_FOG_COORD_ARRAY,
          GL_SECONDARY_COLOR_ARRAY, GL_EDGE_FLAG_ARRAY, GL_INDEX_ARRAY, GL_SCISSOR_TEST})
        state.push_back(glIsEnabled(what));
    for (const GLenum what :
         {GL_ARRAY_BUFFER_BINDING, GL_PIXEL_UNPACK_BUFFER_BINDING, GL_VERTEX_ARRAY_BINDING, GL_CURRENT_PROGRAM, GL_ACTIVE_TEXTURE, GL_CLIENT_ACTIVE_TEXTURE,
          GL_MATRIX_MODE, GL_MODELVIEW_MATRIX, GL_PROJECTION_MATRIX, GL_MODELVIEW_STACK_DEPTH, GL_ATTRIB_STACK_DEPTH, GL_CLIENT_ATTRIB_STACK_DEPTH,
          GL_ALPHA_TEST_FUNC, GL_LOGIC_OP_MODE, GL_LINE_WIDTH, GL_LINE_STIPPLE_REPEAT, GL_POLYGON_MODE, GL_BLEND_SRC_RGB, GL_BLEND_DST_RGB,
          GL_BLEND_SRC_ALPHA, GL_BLEND_DST_ALPHA, GL_BLEND_EQUATION_RGB, GL_UNPACK_ROW_LENGTH, GL_UNPACK_ALIGNMENT, GL_CURRENT_COLOR, GL_CURRENT_NORMAL,
          GL_CURRENT_TEXTURE_COORDS, GL_DRAW_BUFFER, GL_DEPTH_WRITEMASK}) {
        GLfloat values[16] = {};
        glGetFloatv(what, values);
        state.insert(state.end(), values, values + 16);
    }
    GLint active = 0, client = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    glGetIntegerv(GL_CLIENT_ACTIVE_TEXTURE, &client);
    for (GLenum unit = GL_TEXTURE0; unit < GL_TEXTURE4; ++unit) {
        glActiveTexture(unit);
        glClientActiveTexture(unit);
        for (const GLenum what : {GL_TEXTURE_1D, GL_TEXTURE_2D, GL_TEXTURE_3D, GL_TEXTURE_CUBE_MAP, GL_TEXTURE_RECTANGLE, GL_TEXTURE_GEN_S, GL_TEXTURE_GEN_T,
                                  GL_TEXTURE_COORD_ARRAY})
            state.push_back(glIsEnabled(what));
        for (const GLenum what : {GL_TEXTURE_BINDING_2D, GL_TEXTURE_MATRIX, GL_SAMPLER_BINDING}) {
            GLfloat values[16] = {};
            glGetFloatv(what, values);
            state.insert(state.end(), values, values + 16);
        }
        GLint mode = 0;
        glGetTexEnviv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, &mode);
        state.push_back(GLfloat(mode));
    }
    glActiveTexture(GLenum(active));
    glClientActiveTexture(GLenum(client));
    return state;
}

Surface hills() {
    return surfaceOf(fractalMap(97, 65, 30.0));
}

/// A graph of these counters, behind a camera that must not matter to it.
struct GraphScene {
    Ref<SoSeparator> root = new SoSeparator;
    SoPerfGraph* graph = new SoPerfGraph;

    explicit GraphScene(std::initializer_list<const char*> counters) {
        auto* camera = new SoOrthographicCamera;
        camera->position = SbVec3f(40.0f, 2.0f, 1.0f);
        root->addChild(camera);
        graph->counter.setNum(0);
        for (const char* name : counters) graph->counter.set1Value(graph->counter.getNum(), name);
        root->addChild(graph);
    }
    double shown(int index) const {
        double value = -1.0, top = 0.0;
        EXPECT_TRUE(graph->getShown(index, value, top));
        return value;
    }
};

/// Red, green and blue; y from the upper border.
const std::uint8_t* pixelAt(const terrain::Image& image, int x, int y) {
    return image.pixels.data() + (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 3;
}

}  // namespace

TEST(PerfGraph, ShowsWhatWasCountedSinceItsLastFrame) {
    Stage stage;
    GraphScene first({"apples", "pears"}), second({"apples"});
    for (GraphScene* scene : {&first, &second}) stage.render(scene->root.get());
    SoPerfGraph::count("apples", 3.0, "pieces");
    SoPerfGraph::count("apples", 4.0);
    SoPerfGraph::set("pears", 0.5);
    stage.render(first.root.get());
    EXPECT_EQ(first.shown(0), 7.0);
    EXPECT_EQ(first.shown(1), 0.5);
    SoPerfGraph::count("apples", 1.0);
    for (GraphScene* scene : {&first, &second}) stage.render(scene->root.get());
    EXPECT_EQ(first.shown(0), 1.0);
    EXPECT_EQ(first.shown(1), 0.5) << "a value stays";
    EXPECT_EQ(second.shown(0), 8.0) << "a graph takes nothing from another one";
    double value = 0.0, top = 0.0;
    EXPECT_FALSE(second.graph->getShown(1, value, top));
}

TEST(PerfGraph, CountsWhatTheTerrainNodesTell) {
    Stage stage;
    for (const Kind kind : kOurKinds) {
        const auto terrain = sceneOf(kind, hills());
        GraphScene scene({"triangles", "draw calls", "memory", "fps"});
        stage.render(scene.root.get());
        for (int i = 0; i < 2; ++i) {
            double triangles = 0.0, draws = 0.0, megabytes = 0.0;
            for (int frame = 0; frame < 2; ++frame) {
                stage.render(terrain.get());
                const SoTerrainStatistics figures = terrainIn(terrain.get())->getStatistics();
                triangles += figures.triangles;
                draws += figures.drawCalls;
                megabytes = double(figures.memoryBytes);
            }
            stage.render(scene.root.get());
            EXPECT_EQ(scene.shown(0), triangles) << nameOf(kind);
            EXPECT_EQ(scene.shown(1), draws) << nameOf(kind);
            EXPECT_NEAR(scene.shown(2), megabytes, 1e-6) << nameOf(kind);
            EXPECT_GT(scene.shown(3), 0.0);
        }
    }
}

TEST(PerfGraph, DrawsInItsRectangleOnly) {
    Stage stage;
    const auto plain = sceneOf(Kind::Roam, hills()), dressed = sceneOf(Kind::Roam, hills());
    auto* graph = new SoPerfGraph;
    graph->counter.setValue("flat");
    graph->position = SbVec2f(-20.0f, 30.0f);
    graph->size = SbVec2f(100.0f, 50.0f);
    graph->maximum = 10.0f;
    graph->history = 10;
    dressed->addChild(graph);
    const auto without = stage.render(plain.get());
    terrain::Image with;
    for (int i = 0; i < 12; ++i) {
        SoPerfGraph::count("flat", 4.0);
        with = stage.render(dressed.get());
    }
    savePicture("perf_graph", {without, with});
    // From x = 200 to 300 and from y = 30 to 80; pictures begin with their upper row.
    int changedInside = 0, changedOutside = 0;
    std::string where;
    for (int y = 0; y < with.height; ++y)
        for (int x = 0; x < with.width; ++x) {
            const int up = with.height - 1 - y;
            const bool inside = x >= 199 && x <= 300 && up >= 29 && up <= 80;
            if (std::equal(pixelAt(with, x, y), pixelAt(with, x, y) + 3, pixelAt(without, x, y))) continue;
            ++(inside ? changedInside : changedOutside);
            if (!inside) where += std::to_string(x) + ',' + std::to_string(up) + ' ';
        }
    EXPECT_GT(changedInside, 4800);
    EXPECT_EQ(changedOutside, 0) << where;
    // Of 50 pixels the upper 14 are for text; two fifths of the scale are two fifths of the rest. The curve is as coloured as it should be.
    int curve = 0;
    for (int x = 205; x < 295; ++x)
        for (int up = 43; up <= 45; ++up) {
            const std::uint8_t* pixel = pixelAt(with, x, with.height - 1 - up);
            curve += std::abs(pixel[0] - 102) < 4 && std::abs(pixel[1] - 229) < 4 && std::abs(pixel[2] - 102) < 4;
        }
    EXPECT_GE(curve, 85);
}

TEST(PerfGraph, LeavesGlAsItWasAndDependsOnNothingOfIt) {
    Stage stage;
    stage.makeCurrent();
    GraphScene plain({"fps", "triangles"});
    stage.render(plain.root.get());
    // What is drawn under an odd state is what is drawn under GL's own.
    const auto oddities = [] {
        for (const GLenum odd : {GL_ALPHA_TEST, GL_CULL_FACE, GL_DEPTH_TEST, GL_FOG, GL_LIGHTING, GL_STENCIL_TEST, GL_LINE_STIPPLE, GL_POLYGON_STIPPLE,
                                 GL_COLOR_LOGIC_OP, GL_CLIP_PLANE0, GL_CLIP_PLANE3, GL_TEXTURE_1D, GL_TEXTURE_3D, GL_TEXTURE_CUBE_MAP})
            glEnable(odd);
        for (GLenum unit : {GL_TEXTURE3, GL_TEXTURE1}) {
            glActiveTexture(unit);
            glClientActiveTexture(unit);
            glEnable(GL_TEXTURE_2D);
            glEnable(GL_TEXTURE_GEN_S);
            glEnableClientState(GL_TEXTURE_COORD_ARRAY);
        }
        const GLdouble plane[4] = {-1.0, 0.0, 0.0, -1000.0};
        glClipPlane(GL_CLIP_PLANE0, plane);
        glAlphaFunc(GL_LESS, 0.01f);
        glStencilFunc(GL_NEVER, 1, 1);
        glLogicOp(GL_INVERT);
        glLineStipple(3, 0x1111);
        glLineWidth(7.0f);
        glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
        glBlendFunc(GL_ZERO, GL_ONE);
        glBlendEquation(GL_FUNC_REVERSE_SUBTRACT);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 5);
        glColor4f(0.1f, 0.2f, 0.3f, 0.4f);
        glTexCoord2f(0.3f, 0.4f);
        glMatrixMode(GL_TEXTURE);
        glTranslatef(0.3f, 0.0f, 0.0f);
        glActiveTexture(GL_TEXTURE0);
        glTranslatef(0.7f, 0.0f, 0.0f);
        glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_DECAL);
    };
    terrain::OverlayResources resources;
    terrain::OverlayQuads quads;
    quads.addRectangle({10.0f, 10.0f}, {50.0f, 30.0f}, {255, 0, 0, 128});
    terrain::OverlayQuads text;
    text.addText({12.0f, 12.0f}, terrain::glyphsOf("12.3 ms"), {255, 255, 255, 255}, 1);
    const auto overlay = [&] {
        stage.clear();
        const terrain::OverlayScope scope(resources, 320, 240);
        EXPECT_TRUE(scope.canDraw());
        scope.drawRectangles(quads.vertices());
        scope.drawText(text.vertices());
        scope.drawLines(quads.vertices().subspan(0, 4), std::vector<GLsizei>{2, 2}, 1.0f);
    };
    overlay();
    const terrain::Image expected = stage.picture();
    EXPECT_GT(coveredPixels(expected), 700);
    glPushAttrib(GL_ALL_ATTRIB_BITS);
    glPushClientAttrib(GL_CLIENT_ALL_ATTRIB_BITS);
    oddities();
    const std::vector<GLfloat> before = allGlState();
    overlay();
    EXPECT_EQ(allGlState(), before);
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    glPopClientAttrib();
    glPopAttrib();
    const terrain::Image found = stage.picture();
    savePicture("perf_graph_state", {expected, found});
    expectAlike(expected, found, 0.0, "an overlay under an odd state", 0);
    const GLuint font = resources.release();
    glDeleteTextures(1, &font);
}

TEST(PerfGraph, LetsATerrainAfterItLookAsItDoesAlone) {
    Stage stage;
    const auto plain = sceneOf(Kind::Roam, hills(), {}, [](SoSeparator* group) { addTexture(group); });
    const auto graphFirst = sceneOf(Kind::Roam, hills(), {}, [](SoSeparator* group) { addTexture(group); });
    auto* graph = new SoPerfGraph;
    graph->size = SbVec2f(20.0f, 20.0f);
    graphFirst->insertChild(graph, 2);
    terrain::Image with;
    for (int frame = 0; frame < 3; ++frame) with = stage.render(graphFirst.get());
    terrain::Image without = stage.render(plain.get());
    // But for the graphs themselves, in the lowest row.
    for (terrain::Image* image : {&with, &without}) image->height -= 30;
    expectAlike(without, with, 0.0, "a terrain after a graph", 0);
}

TEST(PerfGraph, IsOverTransparentObjectsAfterIt) {
    Stage stage;
    for (const auto type : {SoGLRenderAction::BLEND, SoGLRenderAction::DELAYED_BLEND, SoGLRenderAction::SORTED_OBJECT_BLEND}) {
        stage.action().setTransparencyType(type);
        GraphScene scene({"fps"});
        scene.graph->transparency = 0.0f;
        const terrain::Image alone = stage.render(scene.root.get());
        auto* glass = new SoMaterial;
        glass->emissiveColor = SbColor(0.0f, 1.0f, 0.0f);
        glass->transparency = 0.5f;
        auto* cube = new SoCube;
        cube->width = cube->height = 1000.0f;
        auto* move = new SoTranslation;
        move->translation = SbVec3f(0.0f, 0.0f, -4.0f);
        for (SoNode* node : std::initializer_list<SoNode*>{glass, move, cube}) scene.root->addChild(node);
        const terrain::Image behind = stage.render(scene.root.get());
        // In the middle of the graph nothing is green.
        for (const auto* image : {&alone, &behind}) EXPECT_EQ(pixelAt(*image, 100, image->height - 20)[1], 0) << int(type);
        EXPECT_GT(pixelAt(behind, 250, 20)[1], 30) << "the glass is there";
    }
    stage.action().setTransparencyType(SoGLRenderAction::BLEND);
}

TEST(PerfGraph, DrawsNothingWhereItIsOffOrHasNoCounters) {
    Stage stage;
    GraphScene scene({"fps", "pieces"});
    scene.graph->on = FALSE;
    EXPECT_EQ(coveredPixels(stage.render(scene.root.get())), 0);
    scene.graph->on = TRUE;
    EXPECT_GT(coveredPixels(stage.render(scene.root.get())), 4000);
    scene.graph->on = FALSE;
    stage.render(scene.root.get());
    SoPerfGraph::count("pieces", 1e6);
    scene.graph->on = TRUE;
    stage.render(scene.root.get());
    EXPECT_EQ(scene.shown(1), 0.0) << "what was counted meanwhile is no peak";
    SoPerfGraph::count("pieces", 3.0);
    stage.render(scene.root.get());
    EXPECT_EQ(scene.shown(1), 3.0);
    scene.graph->counter.setNum(0);
    EXPECT_EQ(coveredPixels(stage.render(scene.root.get())), 0);
    scene.graph->counter.setValue("");
    EXPECT_EQ(coveredPixels(stage.render(scene.root.get())), 0);
}

TEST(PerfGraph, FollowsEachOfItsViews) {
    Stage small(200, 150), large(320, 240);
    GraphScene scene({"pieces", "fps"});
    for (int frame = 0; frame < 3; ++frame)
        for (Stage* stage : {&small, &large}) {
            SoPerfGraph::count("pieces", 1.0);
            EXPECT_GT(coveredPixels(stage->render(scene.root.get())), 2000);
            if (frame > 0) {
                EXPECT_EQ(scene.shown(0), 2.0) << "one for each view";
                EXPECT_GT(scene.shown(1), 0.0);
            }
        }
    // Two places on the same screen.
    const Ref<SoSeparator> twice = new SoSeparator;
    twice->addChild(scene.root.get());
    twice->addChild(scene.root.get());
    for (int frame = 0; frame < 3; ++frame) {
        SoPerfGraph::count("pieces", 1.0);
        large.render(twice.get());
    }
    EXPECT_EQ(scene.shown(0), 1.0);
}

TEST(PerfGraph, KeepsItsCurvesWhenAWindowChangesItsSize) {
    Stage stage(320, 240);
    GraphScene scene({"pieces"});
    for (const double amount : {7.0, 0.0, 0.0}) {
        stage.render(scene.root.get());
        SoPerfGraph::count("pieces", amount);
    }
    double value = 0.0, top = 0.0;
    const SbViewportRegion region(250, 200);
    stage.action().setViewportRegion(region);
    stage.draw(scene.root.get(), &region);
    ASSERT_TRUE(scene.graph->getShown(0, value, top));
    EXPECT_EQ(top, 10.0) << "the peak of the larger window is there";
}

TEST(PerfGraph, SaysOnceThatNothingCountsByAName) {
    Stage stage;
    GraphScene scene({"trianlges", "triangles", "fps", ""});
    Messages messages;
    for (int frame = 0; frame < 130; ++frame) stage.render(scene.root.get());
    ASSERT_EQ(messages.all().size(), 1u) << messages.text();
    EXPECT_NE(messages.text().find("\"trianlges\""), std::string::npos) << messages.text();
    EXPECT_NE(messages.text().find("triangles,"), std::string::npos) << messages.text();
    EXPECT_TRUE(std::isnan(scene.shown(0)));
    scene.graph->counter.set1Value(0, "triangels");
    for (int frame = 0; frame < 70; ++frame) stage.render(scene.root.get());
    EXPECT_EQ(messages.all().size(), 2u) << messages.text();
}

TEST(PerfGraph, HasTheCountersThatItsDocumentationListsWithTheirUnits) {
    const char* folder = std::getenv("SOTERRAIN_SRCDIR");
    std::ifstream file(std::string(folder ? folder : ".") + "/nodes/SoPerfGraph.cpp");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::regex row("<tr><td>([^<]*)</td><td>([^<]*)</td>");
    const PerfCounters& counters = PerfCounters::instance();
    std::string ofTerrain;
    for (std::sregex_iterator found(text.begin(), text.end(), row), end; found != end; ++found) {
        const std::string name = (*found)[1], unit = (*found)[2];
        if (name == "fps" || name == "frame" || name == "resident") continue;
        ofTerrain += (ofTerrain.empty() ? "" : ", ") + name;
        EXPECT_EQ(PerfCounters::instance().unitOf(PerfCounters::instance().find(name)), unit) << name;
    }
    // Tests may count by names of their own, after those.
    EXPECT_TRUE(counters.names().starts_with(ofTerrain)) << counters.names();
    EXPECT_GT(ofTerrain.size(), 50u);
}

TEST(PerfGraph, SendsTheSameToGlInEveryFrame) {
    Stage stage;
    GraphScene scene({"selection", "upload", "building", "triangles", "fps", "memory"});
    scene.graph->history = 10;
    int vertices = 0;
    for (int frame = 0; frame < 30; ++frame) {
        stage.makeCurrent();
        GLuint query = 0, primitives = 0;
        glGenQueries(1, &query);
        glBeginQuery(GL_PRIMITIVES_GENERATED, query);
        stage.render(scene.root.get());
        glEndQuery(GL_PRIMITIVES_GENERATED);
        glGetQueryObjectuiv(query, GL_QUERY_RESULT, &primitives);
        glDeleteQueries(1, &query);
        // Six curves, three rectangles each, and letters, of which there are seldom more than twenty.
        EXPECT_LE(primitives, 6u * (9u + 2u * (3u + 40u)));
        vertices = std::max(vertices, int(primitives));
    }
    EXPECT_GT(vertices, 100);
}

TEST(PerfGraph, SurvivesAnyFields) {
    Stage stage;
    GraphScene scene({"", "odd", "fps"});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float number : {0.0f, -1.0f, 1e30f, nan, std::numeric_limits<float>::infinity()}) {
        scene.graph->maximum = number;
        scene.graph->size = SbVec2f(number, number);
        scene.graph->position = SbVec2f(number, number);
        scene.graph->transparency = number;
        scene.graph->history = number < 0.0f ? -5 : 1 << 30;
        scene.graph->columns = number < 0.0f ? -5 : 1 << 30;
        SoPerfGraph::set("odd", double(number));
        SoPerfGraph::count("odder", double(number));
        stage.render(scene.root.get());
    }
    SoPerfGraph::count(nullptr, 1.0, nullptr);
    scene.graph->color.setNum(0);
    stage.render(scene.root.get());
}

TEST(PerfGraph, KnowsTheMemoryOfTheProcess) {
    Stage stage;
    GraphScene scene({"resident"});
    stage.render(scene.root.get());
    EXPECT_GT(scene.shown(0), 1e7);
    EXPECT_LT(scene.shown(0), 1e11);
}

TEST(PerfGraph, FitsIntoTinyViewports) {
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(9, 40), std::pair(40, 9), std::pair(64, 48)}) {
        Stage stage(width, height);
        GraphScene scene({"fps", "triangles", "selection"});
        for (const float place : {3.0f, -3.0f, 0.0f, -100.0f}) {
            scene.graph->position = SbVec2f(place, place);
            for (int frame = 0; frame < 2; ++frame) stage.render(scene.root.get());
        }
    }
}

TEST(PerfPlot, ScalesAreRoundAndDoNotFlicker) {
    EXPECT_EQ(scaleTop(0.0, 0.0), 1.0);
    EXPECT_EQ(scaleTop(7.0, 0.0), 10.0);
    EXPECT_EQ(scaleTop(20.0, 0.0), 20.0);
    EXPECT_EQ(scaleTop(2100.0, 0.0), 5000.0);
    EXPECT_DOUBLE_EQ(scaleTop(0.03, 0.0), 0.05);
    EXPECT_EQ(scaleTop(30.0, 100.0), 100.0) << "what still fits and fills a fifth stays";
    EXPECT_EQ(scaleTop(11.0, 100.0), 20.0);
    for (double value = 1e-6; value < 1e9; value *= 1.37) EXPECT_GE(scaleTop(value, 0.0), value);
}

TEST(PerfPlot, NumbersAreShort) {
    EXPECT_EQ(shortNumber(0.0, ""), "0");
    EXPECT_EQ(shortNumber(0.126, "ms"), "0.13 ms");
    EXPECT_EQ(shortNumber(9.996, "ms"), "10.0 ms");
    EXPECT_EQ(shortNumber(12.34, ""), "12.3");
    EXPECT_EQ(shortNumber(99.96, ""), "100");
    EXPECT_EQ(shortNumber(9999.0, ""), "9999");
    EXPECT_EQ(shortNumber(1234567.0, ""), "1235 k");
    EXPECT_EQ(shortNumber(-20480000.0, ""), "-20.5 M");
    EXPECT_EQ(shortNumber(999.0, "B"), "999 B");
    EXPECT_EQ(shortNumber(20480.0, "B"), "20.5 kB");
    EXPECT_EQ(shortNumber(3.2e10, "B"), "32.0 GB");
    EXPECT_EQ(shortNumber(12345.0, "ms"), "12345 ms");
    EXPECT_EQ(shortNumber(std::nan(""), "ms"), "-");
    for (const double value : {1e-300, 1e300, -1e18}) EXPECT_LE(shortNumber(value, "ms").size(), 12u);
}

TEST(PerfPlot, EndsOfScalesHaveNoEmptyDigits) {
    EXPECT_EQ(roundNumber(2.0, "ms"), "2 ms");
    EXPECT_EQ(roundNumber(0.05, ""), "0.05");
    EXPECT_EQ(roundNumber(0.5, "px"), "0.5 px");
    EXPECT_EQ(roundNumber(50.0, ""), "50");
    EXPECT_EQ(roundNumber(2e7, "B"), "20 MB");
    EXPECT_EQ(roundNumber(100.0, ""), "100");
    EXPECT_EQ(roundNumber(1e-5, ""), "1e-05");
}

TEST(PerfPlot, KeepsTheLatestValuesInOrder) {
    PerfPlot plot;
    for (int i = 0; i < 25; ++i) {
        plot.add(double(i), 10, 100);
        std::vector<float> shown;
        plot.visit([&](const PerfPlot::Point& point) { shown.push_back(point.high); });
        ASSERT_EQ(shown.size(), std::size_t(std::min(i + 1, 10)));
        for (std::size_t k = 0; k < shown.size(); ++k) EXPECT_EQ(shown[k], float(i + 1 - int(shown.size() - k)));
    }
}

TEST(PerfPlot, KeepsPeaksOfMoreFramesThanPoints) {
    PerfPlot plot;
    for (int i = 0; i < 4000; ++i) plot.add(i == 1503 ? 77.0 : i == 1504 ? -3.0 : 1.0, 4000, 100);
    EXPECT_TRUE(plot.isCondensed());
    EXPECT_EQ(plot.size(), 100u);
    int peaks = 0, lows = 0;
    plot.visit([&](const PerfPlot::Point& point) {
        peaks += point.high == 77.0f;
        lows += point.low == -3.0f;
    });
    EXPECT_EQ(peaks, 1);
    EXPECT_EQ(lows, 1);
    plot.scale(0.0);
    EXPECT_EQ(plot.top(), 100.0);
    EXPECT_EQ(plot.bottom(), -5.0);
}
