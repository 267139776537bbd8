// SoTerrainKit: parts, the algorithm as a field, files, copies, picks.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include <Inventor/SoDB.h>
#include <Inventor/SoFullPath.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoOutput.h>
#include <Inventor/SoPickedPoint.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/actions/SoWriteAction.h>
#include <Inventor/details/SoNodeKitDetail.h>
#include <Inventor/engines/SoCalculator.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/nodes/SoCube.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoScale.h>
#include <Inventor/nodes/SoSphere.h>
#include <Inventor/nodes/SoTexture2.h>
#include <Inventor/nodes/SoTransform.h>

#include <SoTerrain/SoBruteForceTerrain.h>
#include <SoTerrain/SoChunkedLoDTerrain.h>
#include <SoTerrain/SoGeoMipmapTerrain.h>
#include <SoTerrain/SoGeometryClipmapTerrain.h>
#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoROAMTerrain.h>
#include <SoTerrain/SoTerrainDetail.h>
#include <SoTerrain/SoTerrainKit.h>
#include <SoTerrain/SoTerrainTexture.h>

using namespace test;

/// A class that the enum does not know, though it knows the class that it is derived from.
class OwnTerrain : public SoROAMTerrain {
    SO_NODE_HEADER(OwnTerrain);

public:
    static void initClass() {
        if (getClassTypeId() == SoType::badType()) SO_NODE_INIT_CLASS(OwnTerrain, SoROAMTerrain, "SoROAMTerrain");
    }
    OwnTerrain() { SO_NODE_CONSTRUCTOR(OwnTerrain); }
};
SO_NODE_SOURCE(OwnTerrain);

namespace {

/// 65 x 65 bytes of hills.
void writeHills(const std::string& path) {
    const auto map = fractalMap(65, 65, 200.0);
    std::ofstream file(path, std::ios::binary);
    for (const float height : map.heights) file.put(char(std::uint8_t(height)));
}

SoTerrainShape* terrainOf(SoTerrainKit* kit) {
    return static_cast<SoTerrainShape*>(kit->getPart("terrain", TRUE));
}

std::string className(const SoNode* node) {
    return node ? node->getTypeId().getName().getString() : "none";
}

void* reallocate(void* pointer, std::size_t size) {
    return std::realloc(pointer, size);
}

std::string write(SoNode* root, bool binary = false) {
    SoOutput output;
    output.setBinary(binary);
    output.setBuffer(std::malloc(1024), 1024, reallocate);
    SoWriteAction action(&output);
    action.apply(root);
    void* buffer = nullptr;
    std::size_t size = 0;
    output.getBuffer(buffer, size);
    const std::string text(static_cast<const char*>(buffer), size);
    std::free(buffer);
    return text;
}

Ref<SoSeparator> read(const std::string& text) {
    SoInput input;
    input.setBuffer(const_cast<char*>(text.data()), text.size());
    return Ref<SoSeparator>(SoDB::readAll(&input));
}

SoTerrainKit* kitIn(SoNode* root) {
    SoSearchAction search;
    search.setType(SoTerrainKit::getClassTypeId());
    search.apply(root);
    return search.getPath() ? static_cast<SoTerrainKit*>(static_cast<SoFullPath*>(search.getPath())->getTail()) : nullptr;
}

Ref<SoSeparator> readKit(const std::string& inside) {
    return read("#Inventor V2.1 ascii\nSoTerrainKit { " + inside + " }");
}

/// A kit of hills in a folder of its own, under a separator with light and camera.
struct KitScene {
    TemporaryFolder folder;
    Ref<SoSeparator> root{new SoSeparator};
    SoTerrainKit* kit = new SoTerrainKit;

    KitScene() {
        writeHills(folder.file("hills.raw"));
        root->addChild(cameraAt(SbVec3f(-15.0f, -25.0f, 45.0f), SbVec3f(32.0f, 32.0f, 5.0f), 1.0f, 300.0f));
        root->addChild(new SoDirectionalLight);
        root->addChild(kit);
        EXPECT_TRUE(kit->set(("heightMap { filename \"" + folder.file("hills.raw") + "\" heightScale 0.1 }").c_str()));
    }
};

constexpr SoTerrainKit::Algorithm kAlgorithms[] = {SoTerrainKit::ROAM, SoTerrainKit::CHUNKED_LOD, SoTerrainKit::GEO_MIPMAP,
                                                   SoTerrainKit::GEOMETRY_CLIPMAP, SoTerrainKit::BRUTE_FORCE};
const char* const kClasses[] = {"SoROAMTerrain", "SoChunkedLoDTerrain", "SoGeoMipmapTerrain", "SoGeometryClipmapTerrain",
                                "SoBruteForceTerrain"};

}  // namespace

TEST(Kit, IsATerrainInOneNode) {
    TemporaryFolder folder;
    writeHills(folder.file("hills.raw"));
    // A colour ramp that Coin reads without help: the file names are relative to the file of the scene.
    std::ofstream(folder.file("scene.iv")) << "#Inventor V2.1 ascii\nSoTerrainKit { algorithm GEO_MIPMAP\n"
                                              "  heightMap SoHeightMap { filename \"hills.raw\" heightScale 0.1 }\n"
                                              "  texture Texture2 { image 2 2 3 0xff0000 0xff00 0xff 0xffffff } }";
    SoInput input;
    ASSERT_TRUE(input.openFile(folder.file("scene.iv").c_str()));
    Ref<SoSeparator> scene(SoDB::readAll(&input));
    ASSERT_TRUE(scene.get());
    Ref<SoSeparator> reference(new SoSeparator);
    auto* texture = new SoTexture2;
    const unsigned char texels[] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
    texture->image.setValue(SbVec2s(2, 2), 3, texels);
    reference->addChild(texture);
    auto* map = new SoHeightMap;
    map->filename = folder.file("hills.raw").c_str();
    map->heightScale = 0.1f;
    reference->addChild(map);
    reference->addChild(new SoGeoMipmapTerrain);
    for (SoSeparator* root : {scene.get(), reference.get()}) {
        root->insertChild(cameraAt(SbVec3f(-15.0f, -25.0f, 45.0f), SbVec3f(32.0f, 32.0f, 5.0f), 1.0f, 300.0f), 0);
        root->insertChild(new SoDirectionalLight, 1);
    }
    Stage stage;
    const auto ours = stage.render(scene.get()), theirs = stage.render(reference.get());
    expectAlike(ours, theirs, 0.0);
    savePicture("kit", {ours, theirs});
}

TEST(Kit, AlgorithmsAreTheClassesOfTheEnum) {
    KitScene scene;
    EXPECT_EQ(scene.kit->algorithm.getValue(), SoTerrainKit::ROAM);
    EXPECT_EQ(className(terrainOf(scene.kit)), "SoROAMTerrain");
    Stage stage;
    const auto full = [&] {
        scene.kit->algorithm = SoTerrainKit::BRUTE_FORCE;
        return stage.render(scene.root.get());
    }();
    std::vector<terrain::Image> pictures{full};
    for (int i = 4; i >= 0; --i) {
        scene.kit->algorithm = kAlgorithms[i];
        EXPECT_EQ(className(terrainOf(scene.kit)), kClasses[i]);
        EXPECT_TRUE(scene.kit->set("terrain { pixelError 0 }"));
        if (kAlgorithms[i] == SoTerrainKit::CHUNKED_LOD) scene.kit->set("terrain { background FALSE }");
        if (kAlgorithms[i] == SoTerrainKit::GEOMETRY_CLIPMAP) scene.kit->set("terrain { clipmapSize 0 }");
        pictures.push_back(stage.render(scene.root.get()));
        expectAlike(pictures.back(), full, 2.0, kClasses[i]);
        const SoField* field = &scene.kit->algorithm;
        SbString name;
        const_cast<SoField*>(field)->get(name);
        EXPECT_GT(name.getLength(), 0);
    }
    savePicture("kit_algorithms", pictures);
}

TEST(Kit, KeepsCommonFieldsAndConnectionsWhenTheAlgorithmChanges) {
    KitScene scene;
    Ref<SoCalculator> engine(new SoCalculator);
    engine->a = 3.0f;
    engine->expression = "oa = a";
    Ref<SoTerrainShape> old(terrainOf(scene.kit));
    old->verticesPerRow = 33;
    old->verticesPerColumn = 17;
    old->startIndex = 65;
    old->frustumCulling = FALSE;
    old->freeze = TRUE;
    old->frozenFrustum = TRUE;
    old->debugView = SoTerrainShape::LEVELS;
    old->wireframeOverlay = TRUE;
    old->setName("mountains");
    old->pixelError.connectFrom(&engine->oa);
    Ref<SoSphere> follower(new SoSphere);
    follower->radius.connectFrom(&old->pixelError);
    Ref<SoScale> source(new SoScale);
    for (int i = 4; i >= 0; --i) {
        scene.kit->algorithm = kAlgorithms[i];
        SoTerrainShape* terrain = terrainOf(scene.kit);
        ASSERT_EQ(className(terrain), kClasses[i]);
        EXPECT_EQ(terrain->verticesPerRow.getValue(), 33);
        EXPECT_EQ(terrain->verticesPerColumn.getValue(), 17);
        EXPECT_EQ(terrain->startIndex.getValue(), 65);
        EXPECT_FALSE(terrain->frustumCulling.getValue());
        EXPECT_TRUE(terrain->freeze.getValue());
        EXPECT_TRUE(terrain->frozenFrustum.getValue());
        EXPECT_EQ(terrain->debugView.getValue(), SoTerrainShape::LEVELS);
        EXPECT_TRUE(terrain->wireframeOverlay.getValue());
        EXPECT_EQ(SoNode::getByName("mountains"), terrain);
        engine->a = 5.0f + float(i);
        EXPECT_EQ(terrain->pixelError.getValue(), 5.0f + float(i));
        EXPECT_EQ(follower->radius.getValue(), 5.0f + float(i));
    }
    EXPECT_FALSE(old->pixelError.isConnected());
    EXPECT_EQ(engine->oa.getNumConnections(), 1);
}

TEST(Kit, AlgorithmMayBeConnected) {
    KitScene scene;
    Ref<SoTerrainKit> other(new SoTerrainKit);
    scene.kit->algorithm.connectFrom(&other->algorithm);
    other->algorithm = SoTerrainKit::BRUTE_FORCE;
    EXPECT_EQ(className(terrainOf(scene.kit)), "SoBruteForceTerrain");
    other->algorithm = SoTerrainKit::ROAM;
    EXPECT_EQ(className(terrainOf(scene.kit)), "SoROAMTerrain");
}

TEST(Kit, ATerrainThatIsSetStaysAndIsFollowedByAlgorithm) {
    OwnTerrain::initClass();
    KitScene scene;
    auto* chunked = new SoChunkedLoDTerrain;
    EXPECT_TRUE(scene.kit->setPart("terrain", chunked));
    EXPECT_EQ(terrainOf(scene.kit), chunked);
    EXPECT_EQ(scene.kit->algorithm.getValue(), SoTerrainKit::CHUNKED_LOD);
    scene.kit->algorithm = SoTerrainKit::CHUNKED_LOD;
    EXPECT_EQ(terrainOf(scene.kit), chunked);
    Ref<OwnTerrain> own(new OwnTerrain);
    own->pixelError = 7.0f;
    EXPECT_TRUE(scene.kit->setPart("terrain", own.get()));
    EXPECT_EQ(scene.kit->algorithm.getValue(), SoTerrainKit::OTHER);
    scene.kit->algorithm = SoTerrainKit::OTHER;
    EXPECT_EQ(terrainOf(scene.kit), own.get());
    Stage stage;
    EXPECT_GT(coveredPixels(stage.render(scene.root.get())), 5000);
    scene.kit->algorithm = SoTerrainKit::ROAM;
    EXPECT_EQ(className(terrainOf(scene.kit)), "SoROAMTerrain");
    EXPECT_EQ(terrainOf(scene.kit)->pixelError.getValue(), 7.0f);
}

TEST(Kit, MakesTheTerrainOfItsAlgorithmWhenThereIsNone) {
    KitScene scene;
    scene.kit->algorithm = SoTerrainKit::GEO_MIPMAP;
    EXPECT_TRUE(scene.kit->setPart("terrain", NULL));
    EXPECT_EQ(scene.kit->getPart("terrain", FALSE), nullptr);
    Stage stage;
    EXPECT_EQ(coveredPixels(stage.render(scene.root.get())), 0);
    EXPECT_EQ(className(terrainOf(scene.kit)), "SoGeoMipmapTerrain");
    EXPECT_EQ(scene.kit->algorithm.getValue(), SoTerrainKit::GEO_MIPMAP);
    EXPECT_GT(coveredPixels(stage.render(scene.root.get())), 5000);
    scene.kit->setPart("terrain", NULL);
    EXPECT_TRUE(scene.kit->set("terrain { tileSize 16 }"));
    EXPECT_EQ(className(terrainOf(scene.kit)), "SoGeoMipmapTerrain");
}

TEST(Kit, WritesPartsThatAreNotDefaultAndReadsThemBack) {
    OwnTerrain::initClass();
    for (const bool binary : {false, true}) {
        Ref<SoSeparator> root(new SoSeparator);
        auto* kit = new SoTerrainKit;
        root->addChild(kit);
        EXPECT_EQ(write(root.get()).find("SoROAMTerrain"), std::string::npos) << write(root.get());
        kit->algorithm = SoTerrainKit::CHUNKED_LOD;
        const std::string plain = write(root.get());
        EXPECT_NE(plain.find("algorithm CHUNKED_LOD"), std::string::npos) << plain;
        EXPECT_EQ(plain.find("SoChunkedLoDTerrain"), std::string::npos) << plain;
        EXPECT_EQ(plain.find("topSeparator Separator"), std::string::npos) << plain;
        Ref<SoSeparator> again = read(write(root.get(), binary));
        ASSERT_TRUE(again.get());
        EXPECT_EQ(className(terrainOf(kitIn(again.get()))), "SoChunkedLoDTerrain");

        // Changed through the part alone, without set().
        terrainOf(kit)->pixelError = 5.0f;
        kit->set("heightMap { heightScale 3 }");
        kit->setPart("texture", new SoTerrainTexture);
        auto* cube = new SoCube;
        static_cast<SoNodeKitListPart*>(kit->getPart("childList", TRUE))->addChild(cube);
        again = read(write(root.get(), binary));
        ASSERT_TRUE(again.get());
        SoTerrainKit* copy = kitIn(again.get());
        ASSERT_TRUE(copy);
        EXPECT_EQ(copy->algorithm.getValue(), SoTerrainKit::CHUNKED_LOD);
        EXPECT_EQ(className(terrainOf(copy)), "SoChunkedLoDTerrain");
        EXPECT_EQ(terrainOf(copy)->pixelError.getValue(), 5.0f);
        EXPECT_EQ(static_cast<SoHeightMap*>(copy->getPart("heightMap", FALSE))->heightScale.getValue(), 3.0f);
        EXPECT_EQ(className(copy->getPart("texture", FALSE)), "SoTerrainTexture");
        EXPECT_EQ(className(copy->getPart("childList[0]", FALSE)), "Cube");
        EXPECT_EQ(copy->getPart("material", FALSE), nullptr);
        if (!binary) {
            EXPECT_EQ(write(root.get()), write(again.get()));
        }

        kit->setPart("terrain", new OwnTerrain);
        again = read(write(root.get(), binary));
        ASSERT_TRUE(again.get());
        EXPECT_EQ(className(terrainOf(kitIn(again.get()))), "OwnTerrain");
        EXPECT_EQ(kitIn(again.get())->algorithm.getValue(), SoTerrainKit::OTHER);
    }
}

TEST(Kit, ReadsATerrainPartBeforeAnAlgorithm) {
    const Ref<SoSeparator> root = readKit("algorithm ROAM terrain SoBruteForceTerrain { pixelError 4 }");
    ASSERT_TRUE(root.get());
    SoTerrainKit* kit = kitIn(root.get());
    EXPECT_EQ(className(terrainOf(kit)), "SoBruteForceTerrain");
    EXPECT_EQ(kit->algorithm.getValue(), SoTerrainKit::BRUTE_FORCE);
    const Ref<SoSeparator> later = readKit("terrain SoGeoMipmapTerrain { } algorithm ROAM");
    EXPECT_EQ(className(terrainOf(kitIn(later.get()))), "SoGeoMipmapTerrain");
}

TEST(Kit, CopiesPartsFieldsAndConnections) {
    KitScene scene;
    Ref<SoCalculator> engine(new SoCalculator);
    engine->a = 3.0f;
    engine->expression = "oa = a";
    scene.kit->algorithm = SoTerrainKit::GEOMETRY_CLIPMAP;
    terrainOf(scene.kit)->pixelError.connectFrom(&engine->oa);
    static_cast<SoMaterial*>(scene.kit->getPart("material", TRUE))->diffuseColor.setValue(1.0f, 0.5f, 0.0f);
    Ref<SoTerrainKit> copy(static_cast<SoTerrainKit*>(scene.kit->copy(TRUE)));
    EXPECT_EQ(copy->algorithm.getValue(), SoTerrainKit::GEOMETRY_CLIPMAP);
    ASSERT_EQ(className(terrainOf(copy.get())), "SoGeometryClipmapTerrain");
    EXPECT_NE(terrainOf(copy.get()), terrainOf(scene.kit));
    engine->a = 6.0f;
    EXPECT_EQ(terrainOf(copy.get())->pixelError.getValue(), 6.0f);
    Stage stage;
    const auto first = stage.render(scene.root.get());
    scene.root->replaceChild(2, copy.get());
    expectAlike(stage.render(scene.root.get()), first, 0.0);
    // The copy goes its own way.
    copy->algorithm = SoTerrainKit::ROAM;
    EXPECT_EQ(terrainOf(copy.get())->pixelError.getValue(), 6.0f);
    EXPECT_EQ(className(terrainOf(copy.get())), "SoROAMTerrain");
}

TEST(Kit, IsSearchedWhereNodekitsAre) {
    KitScene scene;
    SoSearchAction search;
    search.setType(SoTerrainShape::getClassTypeId());
    search.apply(scene.root.get());
    EXPECT_EQ(search.getPath(), nullptr);
    SoBaseKit::setSearchingChildren(TRUE);
    search.reset();
    search.setType(SoTerrainShape::getClassTypeId());
    search.apply(scene.root.get());
    SoBaseKit::setSearchingChildren(FALSE);
    ASSERT_TRUE(search.getPath());
    EXPECT_EQ(static_cast<SoFullPath*>(search.getPath())->getTail(), terrainOf(scene.kit));
}

TEST(Kit, IsPickedAsPartWithATerrainDetail) {
    KitScene scene;
    scene.kit->set("transform { translation 100 0 0 }");
    SoRayPickAction action(SbViewportRegion(320, 240));
    action.setRay(SbVec3f(120.3f, 30.6f, 100.0f), SbVec3f(0.0f, 0.0f, -1.0f));
    action.apply(scene.root.get());
    const SoPickedPoint* picked = action.getPickedPoint();
    ASSERT_TRUE(picked);
    // Coin hides what is inside of a kit.
    EXPECT_EQ(picked->getPath()->getTail(), scene.kit);
    EXPECT_EQ(static_cast<SoFullPath*>(picked->getPath())->getTail(), terrainOf(scene.kit));
    const auto* kitDetail = dynamic_cast<const SoNodeKitDetail*>(picked->getDetail(scene.kit));
    ASSERT_TRUE(kitDetail);
    EXPECT_EQ(kitDetail->getPartName(), SbName("terrain"));
    const auto* detail = dynamic_cast<const SoTerrainDetail*>(picked->getDetail(terrainOf(scene.kit)));
    ASSERT_TRUE(detail);
    EXPECT_EQ(detail->getColumn(), 20);
    EXPECT_EQ(detail->getRow(), 30);
    float height = 0.0f;
    EXPECT_TRUE(terrainOf(scene.kit)->heightAt(20.3f, 30.6f, height));
    EXPECT_NEAR(picked->getPoint()[2], height, 1e-4f);
    SoGetBoundingBoxAction box(SbViewportRegion(320, 240));
    box.apply(scene.kit);
    EXPECT_NEAR(box.getBoundingBox().getMin()[0], 100.0f, 1e-4f);
    EXPECT_NEAR(box.getBoundingBox().getMax()[0], 164.0f, 1e-4f);
}

TEST(Kit, TakesItsHeightsFromCoordinatesToo) {
    Ref<SoSeparator> root = readKit("coordinate3 Coordinate3 { point [0 0 0, 1 0 1, 0 1 2, 1 1 3] }");
    SoGetBoundingBoxAction box(SbViewportRegion(320, 240));
    box.apply(root.get());
    EXPECT_EQ(box.getBoundingBox().getSize(), SbVec3f(1.0f, 1.0f, 3.0f));
}

TEST(Kit, RefusesPartsOfWrongTypesWithAMessage) {
    static int readErrors = 0;
    SoErrorCB* const oldHandler = SoReadError::getHandlerCallback();
    void* const oldData = SoReadError::getHandlerData();
    SoReadError::setHandlerCallback([](const SoError*, void*) { ++readErrors; }, nullptr);
    Ref<SoTerrainKit> kit(new SoTerrainKit);
    for (const char* part : {"terrain", "heightMap", "texture", "color"}) {
        const Ref<SoSphere> sphere(new SoSphere);
        Messages messages;
        EXPECT_FALSE(kit->setPart(part, sphere.get())) << part;
        EXPECT_NE(messages.text().find("part " + std::string(part) + ": expected a"), std::string::npos)
            << part << ": " << messages.text();
        EXPECT_EQ(messages.all().size(), 1u) << messages.text();
    }
    EXPECT_EQ(className(terrainOf(kit.get())), "SoROAMTerrain");
    for (const char* text : {"algorithm GEO_MIPMAP terrain Sphere { }", "heightMap Cube { }", "texture Cube { }"}) {
        Messages messages;
        const Ref<SoSeparator> root = readKit(text);
        EXPECT_EQ(messages.all().size(), 1u) << text << ": " << messages.text();
        ASSERT_TRUE(root.get());
        EXPECT_EQ(kitIn(root.get())->getPart("texture", FALSE), nullptr);
        EXPECT_EQ(kitIn(root.get())->getPart("heightMap", FALSE), nullptr);
        const bool isGeo = std::string(text).find("GEO_MIPMAP") != std::string::npos;
        EXPECT_EQ(className(terrainOf(kitIn(root.get()))), isGeo ? "SoGeoMipmapTerrain" : "SoROAMTerrain");
    }
    for (const char* text : {"algorithm NONSENSE", "terrain { pixelError 3 }", "nonsense 3", "heightMap"}) {
        const int before = readErrors;
        EXPECT_FALSE(readKit(text).get()) << text;
        EXPECT_GT(readErrors, before) << text;
    }
    SoReadError::setHandlerCallback(oldHandler, oldData);
    Messages messages;
    kit->algorithm.setValue(99);
    EXPECT_NE(messages.text().find("found 99"), std::string::npos) << messages.text();
    EXPECT_EQ(className(terrainOf(kit.get())), "SoROAMTerrain");
}

TEST(Kit, TraversesItsPathsAfterTheAlgorithmChanges) {
    KitScene scene;
    SoBaseKit::setSearchingChildren(TRUE);
    SoSearchAction search;
    search.setNode(terrainOf(scene.kit));
    search.apply(scene.root.get());
    SoBaseKit::setSearchingChildren(FALSE);
    ASSERT_TRUE(search.getPath());
    SoPath* path = search.getPath()->copy();
    path->ref();
    scene.kit->algorithm = SoTerrainKit::CHUNKED_LOD;
    SoGetBoundingBoxAction box(SbViewportRegion(320, 240));
    box.apply(path);
    path->unref();
    Stage stage;
    EXPECT_GT(coveredPixels(stage.render(scene.root.get())), 5000);
}
