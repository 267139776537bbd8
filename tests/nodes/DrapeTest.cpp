// SoTerrainDrape: lines and points are seen where they belong, on ground of any level of detail.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include <Inventor/SoDB.h>
#include <Inventor/SoPickedPoint.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/details/SoLineDetail.h>
#include <Inventor/details/SoPointDetail.h>
#include <Inventor/nodes/SoBaseColor.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoDepthBuffer.h>
#include <Inventor/nodes/SoDrawStyle.h>
#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoLineSet.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoMaterialBinding.h>
#include <Inventor/nodes/SoPolygonOffset.h>
#include <Inventor/nodes/SoTransform.h>

#include <SoTerrain/SoTerrainDrape.h>

using namespace test;

namespace {

const std::vector<SbVec2f> kTrack = {{20, 30},  {90, 110},  {130, 60}, {235, 200}, {60, 220},
                                     {40, 120}, {128, 128}, {128, 10}, {250, 10}};

SoTerrainDrape* drapeOf(const std::vector<SbVec2f>& places, float pixelError = 2.0f) {
    auto* drape = new SoTerrainDrape;
    drape->point.setValues(0, int(places.size()), places.data());
    drape->pixelError = pixelError;
    return drape;
}

/// Height of the surface by the triangles of the reference, NAN beside it.
float heightAt(const Surface& surface, float x, float y) {
    const int c = std::clamp(int(x), 0, surface.columns - 2), r = std::clamp(int(y), 0, surface.rows - 2);
    const float u = x - float(c), v = y - float(r);
    const float z00 = surface.at(c, r)[2], z10 = surface.at(c + 1, r)[2], z01 = surface.at(c, r + 1)[2],
                z11 = surface.at(c + 1, r + 1)[2];
    return u + v <= 1.0f ? z00 + u * (z10 - z00) + v * (z01 - z00) : z11 + (1.0f - u) * (z01 - z11) + (1.0f - v) * (z10 - z11);
}

/// Coin's own lines through many points of the surface.
SoSeparator* exactLines(const Surface& surface, const std::vector<SbVec2f>& places) {
    auto* group = new SoSeparator;
    std::vector<SbVec3f> points;
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        const SbVec2f a = places[i], b = places[i + 1];
        const int steps = int((b - a).length() * 8.0f);
        for (int k = 0; k <= steps; ++k) {
            const SbVec2f p = a + (b - a) * (float(k) / float(steps));
            points.emplace_back(p[0], p[1], heightAt(surface, p[0], p[1]));
        }
    }
    auto* coordinates = new SoCoordinate3;
    coordinates->point.setValues(0, int(points.size()), points.data());
    group->addChild(coordinates);
    group->addChild(new SoLineSet);
    return group;
}

/// Unlit green ground and red lines with or without depth test.
struct LineScene {
    Ref<SoSeparator> root{new SoSeparator};
    SoDepthBuffer* depth = new SoDepthBuffer;
    SoDrawStyle* style = new SoDrawStyle;

    LineScene(Kind kind, const Surface& surface, SoCamera* camera, SoNode* lines, bool pushGroundBack = false) {
        root->addChild(camera);
        auto* light = new SoLightModel;
        light->model = SoLightModel::BASE_COLOR;
        root->addChild(light);
        addColor(SbColor(0.0f, 0.8f, 0.0f));
        if (pushGroundBack) root->addChild(new SoPolygonOffset);
        root->addChild(shapeOf(kind, surface, {.pixelError = 2.0f, .normals = false}));
        addColor(SbColor(1.0f, 0.0f, 0.0f));
        root->addChild(depth);
        root->addChild(style);
        auto* group = new SoSeparator;
        auto* coordinates = new SoCoordinate3;
        coordinates->point.setValues(0, int(surface.points.size()), surface.points.data());
        group->addChild(coordinates);
        group->addChild(lines);
        root->addChild(group);
    }
    void addColor(const SbColor& color) {
        auto* node = new SoBaseColor;
        node->rgb.setValue(color);
        root->addChild(node);
    }
    terrain::Image picture(Stage& stage, bool depthTest = true) {
        depth->test = depthTest;
        depth->write = depthTest;
        return stage.render(root.get());
    }
};

bool isRed(const terrain::Image& image, int x, int y) {
    const std::uint8_t* p =
        image.pixels.data() + std::size_t(image.channels) * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
    return p[0] > 200 && p[1] < 60 && p[2] < 60;
}

int redPixels(const terrain::Image& image) {
    int count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) count += isRed(image, x, y);
    return count;
}

/// Red pixels of `image` farther than `distance` from any of `from`, without those at the window's rim, where the other may be
/// outside.
int redBeyond(const terrain::Image& image, const terrain::Image& from, double distance) {
    const int reach = int(std::ceil(distance));
    int count = 0;
    for (int y = reach; y < image.height - reach; ++y)
        for (int x = reach; x < image.width - reach; ++x) {
            if (!isRed(image, x, y)) continue;
            bool near = false;
            for (int dy = -reach; dy <= reach && !near; ++dy)
                for (int dx = -reach; dx <= reach && !near; ++dx)
                    near = dx * dx + dy * dy <= distance * distance && isRed(from, x + dx, y + dy);
            count += !near;
        }
    return count;
}

Surface mountains() {
    return surfaceOf(fractalMap(257, 257, 70.0, 5));
}

SoCamera* looking(const SbVec3f& eye, const SbVec3f& target) {
    return cameraAt(eye, target, 0.5f, 3000.0f);
}

std::vector<std::pair<SbVec3f, SbVec3f>> viewsFromAbove() {
    return {{{128, 120, 420}, {128, 128, 0}},
            {{128, 127, 160}, {128, 128, 30}},
            {{60, 40, 900}, {128, 128, 0}},
            {{90, 80, 130}, {95, 95, 30}}};
}

}  // namespace

TEST(Drape, IsNotHiddenByTheGroundItLiesOn) {
    const Surface surface = mountains();
    Stage stage;
    for (const Kind kind : kOurKinds)
        for (const float width : {1.0f, 5.0f}) {
            std::vector<terrain::Image> pictures;
            for (const auto& [eye, target] : viewsFromAbove()) {
                SoTerrainDrape* drape = drapeOf(kTrack);
                LineScene scene(kind, surface, looking(eye, target), drape);
                scene.style->lineWidth = width;
                // The bound that the clipmap reports may be beyond what others promise.
                if (kind == Kind::Clipmap) drape->terrain = terrainIn(scene.root.get());
                const auto with = scene.picture(stage), without = scene.picture(stage, false);
                const int all = redPixels(without), seen = redPixels(with);
                EXPECT_GT(all, 100);
                EXPECT_GE(seen, 0.995 * all) << nameOf(kind) << ", width " << width << ", from " << eye.toString().getString();
                pictures.push_back(with);
            }
            savePicture("drape_above_" + identifierOf(kind) + "_" + std::to_string(int(width)), pictures);
        }
}

TEST(Drape, IsWhereItBelongsAndHiddenBehindHills) {
    const Surface surface = mountains();
    Stage stage;
    int all = 0, hidden = 0;
    for (const Kind kind : kOurKinds) {
        std::vector<terrain::Image> pictures;
        for (int step = 0; step < 8; ++step) {
            // A flight over the border and along a valley, down to the ground.
            const float t = float(step) / 7.0f;
            const float x = -60.0f + 250.0f * t, y = 20.0f + 60.0f * t;
            const bool inside = x > 0.0f;
            const float ground = inside ? heightAt(surface, x, y) : 20.0f;
            const auto camera = [&] { return looking({x, y, ground + 45.0f - 38.0f * t}, {x + 70.0f, y + 60.0f, 25.0f}); };
            const auto exact = [&] { return exactLines(surface, kTrack); };
            LineScene place(Kind::BruteForce, surface, camera(), exact());
            LineScene visible(Kind::BruteForce, surface, camera(), exact(), true);
            LineScene ours(kind, surface, camera(), drapeOf(kTrack, kind == Kind::BruteForce ? 0.0f : 2.0f));
            const auto placeImage = place.picture(stage, false), visibleImage = visible.picture(stage),
                       oursImage = ours.picture(stage);
            const std::string what = std::string(nameOf(kind)) + ", step " + std::to_string(step);
            // Rasterisation rounds both lines.
            const double off = kind == Kind::BruteForce ? 1.5 : 3.2;
            all += redPixels(placeImage);
            hidden += redPixels(placeImage) - redPixels(visibleImage);
            EXPECT_EQ(redBeyond(oursImage, placeImage, off), 0) << what;
            // What a crest hides by less than the error comes out, also where a line runs along behind it.
            EXPECT_LE(redBeyond(oursImage, visibleImage, off + 1.5), 0.04 * redPixels(oursImage) + 3) << what;
            EXPECT_LE(redBeyond(visibleImage, oursImage, off + 0.5), 0.005 * redPixels(visibleImage) + 1) << what;
            if (step % 2 == 1) pictures.push_back(oursImage);
        }
        savePicture("drape_flight_" + identifierOf(kind), pictures);
    }
    // Else the test would show nothing.
    EXPECT_GT(hidden, all / 10);
    EXPECT_LT(hidden, all * 9 / 10);
}

namespace {

/// A drape of its own places on a scene's heights.
struct Draped {
    Ref<SoSeparator> root{new SoSeparator};
    SoCoordinate3* coordinates = new SoCoordinate3;
    SoTerrainDrape* drape;

    Draped(const Surface& surface, const std::vector<SbVec2f>& places) : drape(drapeOf(places, 0.0f)) {
        coordinates->point.setValues(0, int(surface.points.size()), surface.points.data());
        root->addChild(coordinates);
        root->addChild(drape);
        drape->verticesPerRow = surface.columns;
        drape->verticesPerColumn = surface.rows;
    }
    SbBox3f box() const {
        SoGetBoundingBoxAction action(SbViewportRegion(320, 240));
        action.apply(root.get());
        return action.getBoundingBox();
    }
    std::pair<int, int> count() const {
        SoGetPrimitiveCountAction action;
        action.apply(root.get());
        return {action.getLineCount(), action.getPointCount()};
    }
};

Surface ramp() {
    return surfaceOf(mapOf(11, 11, [](double x, double y) { return 10.0 * x + 5.0 * y; }));
}

struct Segments {
    std::vector<SbVec3f> ends;
    int points = 0;
    std::vector<int> materials;

    static void line(void* closure, SoCallbackAction*, const SoPrimitiveVertex* a, const SoPrimitiveVertex* b) {
        auto* segments = static_cast<Segments*>(closure);
        segments->ends.push_back(a->getPoint());
        segments->ends.push_back(b->getPoint());
        segments->materials.push_back(a->getMaterialIndex());
    }
    static void point(void* closure, SoCallbackAction*, const SoPrimitiveVertex*) { ++static_cast<Segments*>(closure)->points; }
    explicit Segments(SoNode* root) {
        SoCallbackAction action;
        action.addLineSegmentCallback(SoTerrainDrape::getClassTypeId(), line, this);
        action.addPointCallback(SoTerrainDrape::getClassTypeId(), point, this);
        action.apply(root);
    }
};

}  // namespace

TEST(Drape, FollowsFieldsAndHeights) {
    Draped scene(ramp(), {{1, 1}, {9, 1}, {9, 9}, {20, 9}});
    EXPECT_TRUE(scene.box().getMin().equals(SbVec3f(1, 1, 1.5f), 1e-4f)) << scene.box().getMin().toString().getString();
    EXPECT_TRUE(scene.box().getMax().equals(SbVec3f(10, 9, 14.5f), 1e-4f)) << scene.box().getMax().toString().getString();
    scene.drape->offset = 2.0f;
    EXPECT_NEAR(scene.box().getMax()[2], 16.5f, 1e-4f);
    scene.coordinates->point.set1Value(9 * 11 + 10, SbVec3f(10, 9, 30));
    EXPECT_NEAR(scene.box().getMax()[2], 32.0f, 1e-4f);
    scene.drape->point.set1Value(0, SbVec2f(0, 1));
    EXPECT_NEAR(scene.box().getMin()[0], 0.0f, 1e-4f);
    const int32_t counts[] = {2, -1};
    scene.drape->numVertices.setValues(0, 2, counts);
    EXPECT_EQ(scene.count().first, int(Segments(scene.root.get()).ends.size()) / 2);
    EXPECT_GE(scene.count().first, 10);
    scene.drape->kind = SoTerrainDrape::POINTS;
    EXPECT_EQ(scene.count(), std::make_pair(0, 3));
    EXPECT_EQ(Segments(scene.root.get()).points, 3);
    scene.drape->point.setNum(0);
    EXPECT_TRUE(scene.box().isEmpty());
}

TEST(Drape, FollowsHeightsAlongAnyAxis) {
    Surface surface = ramp();
    for (SbVec3f& p : surface.points) p.setValue(p[0], p[2], p[1]);
    Draped scene(surface, {{1, 2}, {9, 2}});
    EXPECT_TRUE(scene.box().getMin().equals(SbVec3f(1, 2, 2), 1e-4f)) << scene.box().getMin().toString().getString();
    EXPECT_TRUE(scene.box().getMax().equals(SbVec3f(9, 10, 2), 1e-4f)) << scene.box().getMax().toString().getString();
}

TEST(Drape, IsPickedWithDetailsAndRadius) {
    Draped scene(ramp(), {{1, 1}, {9, 1}, {9, 9}, {2, 2}, {2, 8}});
    const int32_t counts[] = {3, 2};
    scene.drape->numVertices.setValues(0, 2, counts);
    auto* transform = new SoTransform;
    transform->translation.setValue(100.0f, 0.0f, 0.0f);
    scene.root->insertChild(transform, 0);
    SoCamera* camera = cameraAt(SbVec3f(105, 5, 60), SbVec3f(105, 5.01f, 0), 1.0f, 200.0f);
    scene.root->insertChild(camera, 0);
    SoRayPickAction action(SbViewportRegion(400, 400));
    action.setRadius(5.0f);
    // Some pixels beside what is at (x, y, z).
    const auto pickAt = [&](float x, float y, float z, float beside) {
        SbVec3f screen;
        camera->getViewVolume(1.0f).projectToScreen(SbVec3f(x, y, z), screen);
        action.setNormalizedPoint(SbVec2f(screen[0] + beside / 400.0f, screen[1]));
        action.apply(scene.root.get());
        return action.getPickedPoint();
    };
    const SoPickedPoint* picked = pickAt(109.0f, 4.3f, 11.15f, 3.0f);
    ASSERT_TRUE(picked);
    EXPECT_NEAR(picked->getPoint()[2], 9.0f + 2.15f, 0.05f);
    const auto* line = dynamic_cast<const SoLineDetail*>(picked->getDetail());
    ASSERT_TRUE(line);
    EXPECT_EQ(line->getLineIndex(), 0);
    EXPECT_EQ(line->getPartIndex(), 1);
    EXPECT_EQ(line->getPoint0()->getCoordinateIndex(), 1);
    EXPECT_EQ(line->getPoint1()->getCoordinateIndex(), 2);
    picked = pickAt(102.0f, 5.0f, 4.5f, -3.0f);
    ASSERT_TRUE(picked);
    EXPECT_EQ(static_cast<const SoLineDetail*>(picked->getDetail())->getLineIndex(), 1);
    EXPECT_FALSE(pickAt(109.0f, 4.3f, 11.15f, 8.0f));
    scene.drape->kind = SoTerrainDrape::POINTS;
    EXPECT_FALSE(pickAt(109.0f, 4.3f, 11.15f, 0.0f));
    picked = pickAt(109.0f, 9.0f, 13.5f, 3.0f);
    ASSERT_TRUE(picked);
    const auto* point = dynamic_cast<const SoPointDetail*>(picked->getDetail());
    ASSERT_TRUE(point);
    EXPECT_EQ(point->getCoordinateIndex(), 2);
}

TEST(Drape, TakesMaterialsByPolylineSegmentAndPoint) {
    const Surface surface = ramp();
    const SbColor colours[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}};
    Stage stage;
    std::vector<terrain::Image> pictures;
    const auto has = [&](const terrain::Image& image, const SbColor& colour) {
        for (std::size_t i = 0; i < image.pixels.size(); i += std::size_t(image.channels))
            if (std::fabs(image.pixels[i] - 255 * colour[0]) < 12 && std::fabs(image.pixels[i + 1] - 255 * colour[1]) < 12 &&
                std::fabs(image.pixels[i + 2] - 255 * colour[2]) < 12)
                return true;
        return false;
    };
    const auto expectColours = [&](SoMaterialBinding::Binding binding, std::vector<int> expected) {
        Draped scene(surface, {{1, 1}, {9, 1}, {9, 9}, {2, 2}, {2, 8}});
        const int32_t counts[] = {3, 2};
        scene.drape->numVertices.setValues(0, 2, counts);
        auto* material = new SoMaterial;
        material->diffuseColor.setValues(0, 5, colours);
        auto* bound = new SoMaterialBinding;
        bound->value = binding;
        auto* style = new SoDrawStyle;
        style->lineWidth = 3.0f;
        for (SoNode* node : std::initializer_list<SoNode*>{style, bound, material,
                                                           cameraAt(SbVec3f(5, 5, 40), SbVec3f(5, 5.01f, 0), 1.0f, 100.0f)})
            scene.root->insertChild(node, 0);
        pictures.push_back(stage.render(scene.root.get()));
        for (int i = 0; i < 5; ++i)
            EXPECT_EQ(has(pictures.back(), colours[i]), std::find(expected.begin(), expected.end(), i) != expected.end())
                << "binding " << binding << ", colour " << i;
    };
    expectColours(SoMaterialBinding::OVERALL, {0});
    expectColours(SoMaterialBinding::PER_FACE, {0, 1});
    expectColours(SoMaterialBinding::PER_PART, {0, 1, 2});
    expectColours(SoMaterialBinding::PER_VERTEX, {0, 1, 2, 3, 4});
    savePicture("drape_materials", pictures);
}

TEST(Drape, FollowsDrawStyle) {
    const Surface surface = ramp();
    Stage stage;
    std::vector<terrain::Image> pictures;
    const auto covered = [&](const std::function<void(SoDrawStyle*, SoTerrainDrape*)>& set) {
        Draped scene(surface, {{1, 5}, {9, 5}});
        auto* style = new SoDrawStyle;
        set(style, scene.drape);
        scene.root->insertChild(style, 0);
        scene.root->insertChild(cameraAt(SbVec3f(5, 5, 40), SbVec3f(5, 5.01f, 0), 1.0f, 100.0f), 0);
        pictures.push_back(stage.render(scene.root.get()));
        return coveredPixels(pictures.back());
    };
    const int thin = covered([](SoDrawStyle*, SoTerrainDrape*) {});
    EXPECT_GT(thin, 40);
    EXPECT_NEAR(covered([](SoDrawStyle* style, SoTerrainDrape*) { style->lineWidth = 4.0f; }), 4 * thin, thin / 4);
    EXPECT_NEAR(covered([](SoDrawStyle* style, SoTerrainDrape*) { style->linePattern = 0x0f0f; }), thin / 2, 6);
    EXPECT_EQ(covered([](SoDrawStyle* style, SoTerrainDrape* drape) {
                  style->pointSize = 6.0f;
                  drape->kind = SoTerrainDrape::POINTS;
              }),
              2 * 36);
    EXPECT_EQ(covered([](SoDrawStyle* style, SoTerrainDrape*) {
                  style->pointSize = 6.0f;
                  style->style = SoDrawStyle::POINTS;
              }),
              2 * 36);
    EXPECT_EQ(covered([](SoDrawStyle* style, SoTerrainDrape*) { style->style = SoDrawStyle::INVISIBLE; }), 0);
    savePicture("drape_styles", pictures);
}

TEST(Drape, DeletesItsBuffersInTheirContexts) {
    const auto surface = ramp();
    const auto buffers = [] {
        int live = 0;
        for (GLuint name = 1; name < 200; ++name) live += glIsBuffer(name) == GL_TRUE;
        return live;
    };
    Stage stage, other;
    stage.makeCurrent();
    const int before = buffers();
    Ref<SoNode> camera(cameraAt(SbVec3f(5, 5, 40), SbVec3f(5, 5.01f, 0), 1.0f, 100.0f));
    Ref<SoSeparator> empty(new SoSeparator);
    {
        Draped scene(surface, {{1, 5}, {9, 5}});
        scene.root->insertChild(camera.get(), 0);
        auto* style = new SoDrawStyle;
        style->lineWidth = 6.0f;
        scene.root->insertChild(style, 0);
        stage.render(scene.root.get());
        EXPECT_GT(buffers(), before);
        expectAlike(other.render(scene.root.get()), stage.render(scene.root.get()), 0.0);
    }
    // What a node leaves is deleted when its context is next current.
    stage.render(empty.get());
    EXPECT_EQ(buffers(), before);
}

TEST(Drape, SaysWhatIsWrong) {
    const auto warns = [](const std::function<void(Draped&)>& spoil, const std::string& text) {
        Draped scene(ramp(), {{1, 5}, {9, 5}});
        scene.root->insertChild(cameraAt(SbVec3f(5, 5, 40), SbVec3f(5, 5.01f, 0), 1.0f, 100.0f), 0);
        spoil(scene);
        Messages messages;
        Stage stage;
        stage.render(scene.root.get());
        stage.render(scene.root.get());
        EXPECT_EQ(messages.all().size(), 1u) << text << ": " << messages.text();
        EXPECT_NE(messages.text().find(text), std::string::npos) << messages.text();
    };
    warns([](Draped& scene) { scene.root->removeChild(scene.coordinates); },
          "expected an SoHeightMap or an SoCoordinate3 before it");
    warns([](Draped& scene) { scene.drape->pixelError = -1.0f; }, "pixelError: expected 0 or more");
    warns([](Draped& scene) { scene.drape->numVertices = 3; }, "numVertices: expected 3 more points, found 2");
    warns([](Draped& scene) { scene.drape->terrain = new SoSeparator; }, "expected an SoTerrainShape");
    warns([](Draped& scene) { scene.drape->verticesPerRow = 300; }, "expected 300 x");
    warns([](Draped& scene) { scene.coordinates->point.set1Value(12, SbVec3f(1.4f, 1, 3)); },
          "expected heights over a regular grid");
}
