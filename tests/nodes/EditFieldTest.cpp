// What a change of each field does: what it builds anew, what it sends to GL, and that the picture is that of nodes made with it.
#include "EditScene.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include <Inventor/SoLists.h>
#include <Inventor/fields/SoField.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoMaterialBinding.h>
#include <Inventor/nodes/SoNormal.h>
#include <Inventor/nodes/SoTexture2.h>
#include <Inventor/nodes/SoTextureCoordinate2.h>

#include <SoTerrain/SoBruteForceTerrain.h>
#include <SoTerrain/SoGeoMipmapTerrain.h>
#include <SoTerrain/SoGeometryClipmapTerrain.h>
#include <SoTerrain/SoROAMTerrain.h>

using namespace test;
using terrain::Image;

namespace {

/// What a change may cost at most, each more than the one before.
enum class Work {
    Nothing,  ///< a frame like any other
    Choice,   ///< another part of the mesh, or another mesh: vertices of it that were not there, and no height looked at
    Mesh,     ///< a mesh made anew, over bounds and errors that stay
    Measure,  ///< bounds and errors, of heights that are in memory
    File      ///< heights read again
};

struct FieldChange {
    const char* field;  ///< class and name
    const char* value;
    Work work;
};

// Terrain of 100 x 65 samples from number 1458 on, in files of 144 x 144: see sceneFor().
const FieldChange kFieldChanges[] = {
    {"SoHeightMap.filename", nullptr, Work::File},
    {"SoHeightMap.spacing", "1.3 0.9", Work::Choice},
    {"SoHeightMap.heightScale", "0.0035", Work::Measure},
    {"SoHeightMap.heightOffset", "3.5", Work::Measure},
    {"SoHeightMap.origin", "7 -3", Work::Choice},
    {"SoHeightMap.channel", "0", Work::File},
    {"SoHeightMap.rawSize", "162 128", Work::File},
    {"SoHeightMap.rawType", "UINT16_BIG_ENDIAN", Work::File},
    {"SoHeightMap.noData", "7710", Work::File},
    {"SoTerrainShape.verticesPerRow", "90", Work::Measure},
    {"SoTerrainShape.verticesPerColumn", "50", Work::Measure},
    {"SoTerrainShape.startIndex", "2900", Work::Measure},
    {"SoTerrainShape.pixelError", "4", Work::Choice},
    {"SoTerrainShape.frustumCulling", "FALSE", Work::Choice},
    {"SoTerrainShape.freeze", "TRUE", Work::Nothing},
    {"SoTerrainShape.frozenFrustum", "TRUE", Work::Nothing},
    {"SoTerrainShape.debugView", "LEVELS", Work::Mesh},
    {"SoTerrainShape.wireframeOverlay", "TRUE", Work::Mesh},
    {"SoTerrainShape.alternateRep", "Cube {}", Work::Nothing},
    {"SoROAMTerrain.triangleCount", "700", Work::Choice},
    {"SoROAMTerrain.geomorph", "TRUE", Work::Choice},
    {"SoROAMTerrain.operationCount", "100", Work::Nothing},
    {"SoGeoMipmapTerrain.tileSize", "16", Work::Mesh},
    {"SoGeoMipmapTerrain.morphing", "FALSE", Work::Choice},
    {"SoChunkedLoDTerrain.tileSize", "32", Work::Mesh},
    {"SoChunkedLoDTerrain.morphing", "FALSE", Work::Choice},
    {"SoChunkedLoDTerrain.memoryBudget", "3", Work::Nothing},
    {"SoChunkedLoDTerrain.uploadBudget", "100", Work::Nothing},
    {"SoChunkedLoDTerrain.background", "TRUE", Work::Nothing},
    {"SoGeometryClipmapTerrain.clipmapSize", "63", Work::Mesh},
    {"SoGeometryClipmapTerrain.levels", "2", Work::Mesh},
    {"SoGeometryClipmapTerrain.transitionWidth", "5", Work::Mesh},
    {"SoGeometryClipmapTerrain.updateBudget", "100000", Work::Mesh},
    {"SoGeometryClipmapTerrain.activeLevels", "2", Work::Mesh},
    {"SoGeometryClipmapTerrain.detailLevels", "2", Work::Mesh},
    {"SoGeometryClipmapTerrain.detailAmplitude", "3", Work::Mesh},
    {"SoGeometryClipmapTerrain.detailSeed", "7", Work::Mesh},
    {"SoGeometryClipmapTerrain.blendNormals", "FALSE", Work::Choice},
    {"SoGeometryClipmapTerrain.implementation", "CPU", Work::Mesh},
    {"SoGeometryClipmapTerrain.storage", "MEMORY_FREE", Work::Mesh},
    {"SoGeometryClipmapTerrain.showLevels", "TRUE", Work::Choice},
};

std::string fieldName(SoField* field) {
    SbName name;
    field->getContainer()->getFieldName(field, name);
    return name.getString();
}

/// Names of the fields of a class as the table has them.
std::vector<std::string> fieldsOf(SoType type) {
    Ref<SoNode> node(static_cast<SoNode*>(type.createInstance()));
    SoFieldList fields;
    const int number = node->getFields(fields);
    std::vector<std::string> names;
    for (int i = 0; i < number; ++i) names.push_back(std::string(type.getName().getString()) + '.' + fieldName(fields[i]));
    return names;
}

std::string memberOf(const char* field) {
    return std::string(field).substr(std::string(field).find('.') + 1);
}

class EditedFields : public testing::TestWithParam<Kind> {
protected:
    static constexpr int kSide = 144;

    /// Samples of two bytes, of which the higher is half of the lower: a gentle terrain whichever comes first.
    void write(const std::string& name, bool mirrored) const {
        std::ofstream file(folder.file(name), std::ios::binary);
        Heights heights = hills(kSide);
        if (mirrored) std::reverse(heights.begin(), heights.end());
        for (const float height : heights) {
            const int low = std::clamp(int(6.0f * height), 0, 255);
            file.put(char(low)).put(char(low / 2));
        }
    }
    EditScene sceneFor() const {
        EditScene scene(GetParam(), 2, Heights(4, 0.0f));
        scene.map->rawType = SoHeightMap::UINT16_LITTLE_ENDIAN;
        scene.map->heightScale = 0.002f;
        scene.map->filename = folder.file("hills.raw").c_str();
        scene.node->verticesPerRow = 100;
        scene.node->verticesPerColumn = 65;
        scene.node->startIndex = 1458;
        scene.root->replaceChild(0, cameraAt(SbVec3f(30.0f, 2.0f, 45.0f), SbVec3f(70.0f, 45.0f, 5.0f), 1.0f, 300.0f));
        // Without a size that fits the view, levels would be all of it.
        if (auto* clipmap = dynamic_cast<SoGeometryClipmapTerrain*>(scene.node)) {
            clipmap->clipmapSize = 31;
            clipmap->detailAmplitude = 2.0f;
        }
        return scene;
    }
    /// New nodes with the values that these have.
    EditScene freshOf(const EditScene& scene) const {
        EditScene made = sceneFor();
        made.root->replaceChild(0, scene.root->getChild(0));
        made.map->copyFieldValues(scene.map);
        made.node->copyFieldValues(scene.node);
        return made;
    }

    struct Drawn {
        Image picture;
        double buildMilliseconds = 0.0;
        std::size_t bytes = 0, newVertexBytes = 0;
    };
    /// Frames until there is no more to come.
    Drawn drawn(Stage& stage, SoNode* root, SoTerrainShape* node) const {
        Drawn drawn;
        for (int i = 0; i < 30; ++i) {
            drawn.picture = stage.render(root);
            const SoTerrainStatistics statistics = node->getStatistics();
            drawn.buildMilliseconds += statistics.buildMilliseconds;
            drawn.bytes += statistics.uploadedBytes;
            drawn.newVertexBytes += statistics.newVertexBytes;
            if (statistics.converged) return drawn;
        }
        ADD_FAILURE() << "never converged";
        return drawn;
    }
    void expectWork(Stage& stage, const FieldChange& change) const;

    TemporaryFolder folder;
};

void EditedFields::expectWork(Stage& stage, const FieldChange& change) const {
    write("hills.raw", false);
    write("others.raw", true);
    const EditScene scene = sceneFor();
    const Drawn first = drawn(stage, scene.root.get(), scene.node);
    const Drawn still = drawn(stage, scene.root.get(), scene.node);
    // A file that is read again has other heights now; one that is not might as well be gone.
    write("hills.raw", true);
    if (change.work != Work::File) std::filesystem::remove(folder.file("hills.raw"));
    SoNode* of = std::string(change.field).starts_with("SoHeightMap.") ? static_cast<SoNode*>(scene.map) : scene.node;
    SoField* field = of->getField(memberOf(change.field).c_str());
    ASSERT_TRUE(field);
    ASSERT_TRUE(field->set(change.value ? change.value : ("\"" + folder.file("others.raw") + "\"").c_str()));
    const Drawn edited = drawn(stage, scene.root.get(), scene.node);
    if (change.work != Work::File) write("hills.raw", false);
    const EditScene made = freshOf(scene);
    const Drawn fresh = drawn(stage, made.root.get(), made.node);
    expectAlike(fresh.picture, edited.picture, GetParam() == Kind::BruteForce ? 0.001 : 1.5, change.field);
    if (change.work == Work::File) {
        EXPECT_GT(compare(still.picture, edited.picture).mean, 2.0) << "the file's new heights";
    }
    if (change.work <= Work::Choice) {
        EXPECT_EQ(edited.buildMilliseconds, 0.0);
    }
    if (change.work == Work::Nothing) {
        EXPECT_LE(edited.bytes, still.bytes);
    }
    // Of a mesh that gets coarser there is as much as before.
    const std::size_t most = std::max(first.bytes, fresh.bytes);
    EXPECT_LE(edited.bytes, most + most / 10);
}

}  // namespace

TEST_P(EditedFields, BuildAndSendNoMoreThanDependsOnThem) {
    Stage stage;
    const SoType own = sceneFor().node->getTypeId();
    for (const FieldChange& change : kFieldChanges) {
        SCOPED_TRACE(change.field);
        const std::string owner = std::string(change.field).substr(0, std::string(change.field).find('.'));
        if (owner == "SoHeightMap" || owner == "SoTerrainShape" || own.getName() == owner.c_str()) expectWork(stage, change);
    }
}

TEST(EditedFieldTable, HasEveryFieldOfEveryTerrainNode) {
    std::set<std::string> known;
    for (const FieldChange& change : kFieldChanges) EXPECT_TRUE(known.insert(change.field).second) << change.field << " twice";
    SoTypeList types;
    SoType::getAllDerivedFrom(SoTerrainShape::getClassTypeId(), types);
    types.append(SoHeightMap::getClassTypeId());
    EXPECT_GE(types.getLength(), int(std::size(kOurKinds)) + 1);
    for (int i = 0; i < types.getLength(); ++i) {
        if (!types[i].canCreateInstance()) continue;
        for (const std::string& field : fieldsOf(types[i])) {
            const std::string shared = "SoTerrainShape." + memberOf(field.c_str());
            EXPECT_TRUE(known.count(field) || (types[i] != SoHeightMap::getClassTypeId() && known.count(shared)))
                << field << " has no row";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Nodes, EditedFields, testing::ValuesIn(kOurKinds),
                         [](const auto& info) { return identifierOf(info.param); });

namespace {

/// A surface with a texture, a material, a normal, a coordinate and a texture coordinate for each sample, and one of them changed.
struct StateScene {
    Ref<SoSeparator> root = new SoSeparator;
    SoTexture2* texture = nullptr;
    SoMaterial* overall = new SoMaterial;
    SoMaterial* colours = new SoMaterial;
    SoNormal* normals = nullptr;
    SoCoordinate3* coordinates = nullptr;
    SoTextureCoordinate2* places = nullptr;
    SoTerrainShape* node = nullptr;

    StateScene(Kind kind, const Surface& surface, bool coloured, bool isOwn) {
        root->addChild(cameraFor(surface.box()));
        auto* light = new SoDirectionalLight;
        light->direction = SbVec3f(0.6f, -0.3f, -0.7f);
        root->addChild(light);
        addTexture(root.get());
        if (coloured) {
            colours->diffuseColor.setNum(int(surface.points.size()));
            for (int i = 0; i < int(surface.points.size()); ++i)
                colours->diffuseColor.set1Value(i, 0.5f + 0.5f * float(i % 7) / 6.0f, 0.8f, 0.9f);
            auto* binding = new SoMaterialBinding;
            binding->value = SoMaterialBinding::PER_VERTEX;
            root->addChild(colours);
            root->addChild(binding);
        } else {
            root->addChild(overall);
        }
        SoSeparator* shape = shapeOf(kind, surface, {.pixelError = 1.0f, .normals = true, .coordinatesOnUnit = 0});
        root->addChild(shape);
        for (const auto& group : {root.get(), shape})
            for (int i = 0; i < group->getNumChildren(); ++i) {
                SoNode* child = group->getChild(i);
                if (auto* found = dynamic_cast<SoTexture2*>(child)) texture = found;
                if (auto* found = dynamic_cast<SoNormal*>(child)) normals = found;
                if (auto* found = dynamic_cast<SoCoordinate3*>(child)) coordinates = found;
                if (auto* found = dynamic_cast<SoTextureCoordinate2*>(child)) places = found;
            }
        // Clipmaps draw such from vertex arrays.
        if (isOwn) {
            normals->vector.set1Value(0, SbVec3f(0.0f, 1.0f, 0.0f));
            places->point.set1Value(0, 0.5f, 0.5f);
        }
        node = terrainIn(root.get());
        if (auto* tiles = dynamic_cast<SoChunkedLoDTerrain*>(node)) tiles->background = FALSE;
    }
};

struct StateChange {
    const char* what;
    bool coloured;
    bool isInVertices;
    std::function<void(StateScene&)> apply;
};

// In every mesh, however coarse.
constexpr int kSample = 64 * 129 + 64;

const StateChange kStateChanges[] = {
    {"texture", false, false,
     [](StateScene& scene) {
         const unsigned char texels[] = {255, 40, 40, 40, 255, 40, 40, 40, 255, 255, 255, 40};
         scene.texture->image.setValue(SbVec2s(2, 2), 3, texels);
     }},
    {"material", false, false, [](StateScene& scene) { scene.overall->diffuseColor = SbColor(0.2f, 0.9f, 0.3f); }},
    {"one material", true, true, [](StateScene& scene) { scene.colours->diffuseColor.set1Value(kSample, 1.0f, 0.0f, 0.0f); }},
    {"one normal", false, true, [](StateScene& scene) { scene.normals->vector.set1Value(kSample, SbVec3f(1.0f, 0.0f, 0.0f)); }},
    {"one coordinate", false, true,
     [](StateScene& scene) {
         scene.coordinates->point.set1Value(kSample, scene.coordinates->point[kSample] + SbVec3f(0.0f, 0.0f, 9.0f));
     }},
    {"one texture coordinate", false, true, [](StateScene& scene) { scene.places->point.set1Value(kSample, 0.9f, 0.1f); }},
};

class EditedState : public testing::TestWithParam<Kind> {};

}  // namespace

TEST_P(EditedState, SendsNoMoreThanTheMeshAndMeasuresNothing) {
    const Surface surface = surfaceOf(fractalMap(129, 129, 20.0));
    Stage stage;
    for (const StateChange& change : kStateChanges) {
        SCOPED_TRACE(change.what);
        StateScene scene(GetParam(), surface, change.coloured, change.isInVertices),
            other(GetParam(), surface, change.coloured, change.isInVertices);
        stage.render(scene.root.get());
        const Image before = stage.render(scene.root.get());
        const std::size_t still = scene.node->getStatistics().uploadedBytes;
        change.apply(scene);
        change.apply(other);
        const Image edited = stage.render(scene.root.get());
        const SoTerrainStatistics statistics = scene.node->getStatistics();
        EXPECT_EQ(statistics.buildMilliseconds, 0.0);
        EXPECT_GT(compare(before, edited).largest, 20) << "nothing changed";
        expectAlike(stage.render(other.root.get()), edited, GetParam() == Kind::BruteForce ? 0.0 : 1.0, change.what);
        const std::size_t fresh = other.node->getStatistics().uploadedBytes;
        EXPECT_LE(statistics.uploadedBytes, change.isInVertices ? fresh + fresh / 10 : still);
        if (GetParam() == Kind::BruteForce && std::string(change.what) == "one coordinate") {
            EXPECT_LE(statistics.uploadedBytes, fresh / 10);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Nodes, EditedState, testing::ValuesIn(kOurKinds),
                         [](const auto& info) { return identifierOf(info.param); });

TEST(HeightMapEdits, StayWhenHeightsAreScaled) {
    const TemporaryFolder folder;
    {
        std::ofstream file(folder.file("plain.raw"), std::ios::binary);
        for (int i = 0; i < 81; ++i) file.put(char(i));
    }
    Ref<SoHeightMap> map(new SoHeightMap);
    map->heightScale = 0.5f;
    map->filename = folder.file("plain.raw").c_str();
    const Heights edit = {50.0f, kNaN};
    ASSERT_TRUE(map->setHeights(3, 3, 2, 1, edit.data()));
    const auto at = [&](int column, int row) {
        float height = 0.0f;
        EXPECT_TRUE(map->getHeights(column, row, 1, 1, &height));
        return height;
    };
    Ref<SoHeightMap> copy(static_cast<SoHeightMap*>(map->copy()));
    for (int i = 1; i <= 100; ++i) {
        map->heightScale = 0.5f + 0.01f * float(i);
        map->heightOffset = -0.1f * float(i);
        EXPECT_NEAR(at(3, 3), 100.0 * map->heightScale.getValue() + map->heightOffset.getValue(), 1e-3);
    }
    EXPECT_TRUE(std::isnan(at(4, 3)));
    EXPECT_NEAR(at(0, 0), 72.0 * 1.5 - 10.0, 1e-3);
    float height = 0.0f;
    EXPECT_TRUE(copy->getHeights(3, 3, 1, 1, &height));
    EXPECT_EQ(height, 50.0f);
    // Of a factor of 0 nothing is left to scale.
    map->heightScale = 0.0f;
    EXPECT_NEAR(at(0, 0), -10.0f, 1e-6);
    map->heightScale = 0.5f;
    map->heightOffset = 0.0f;
    EXPECT_EQ(at(3, 3), 0.5f * float(5 * 9 + 3));
}

TEST(HeightMapScale, ReadsTheFileAgainRatherThanRoundHeights) {
    const TemporaryFolder folder;
    {
        std::ofstream file(folder.file("plain.raw"), std::ios::binary);
        for (int i = 0; i < 81; ++i) file.put(char(i));
    }
    Ref<SoHeightMap> map(new SoHeightMap);
    map->filename = folder.file("plain.raw").c_str();
    ASSERT_TRUE(map->isLoaded());
    map->heightOffset = 1e8f;
    ASSERT_TRUE(map->isLoaded());
    map->heightOffset = 0.0f;
    Heights heights(81);
    ASSERT_TRUE(map->getHeights(0, 0, 9, 9, heights.data()));
    for (int i = 0; i < 81; ++i) EXPECT_EQ(heights[std::size_t(i)], float((8 - i / 9) * 9 + i % 9));
}
