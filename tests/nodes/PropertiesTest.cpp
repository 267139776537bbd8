// Material, normal, texture, light and shader properties act on the nodes as they do on Coin's own shapes.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Inventor/nodes/SoClipPlane.h>
#include <Inventor/nodes/SoEnvironment.h>
#include <Inventor/nodes/SoFragmentShader.h>
#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoMaterialBinding.h>
#include <Inventor/nodes/SoNormalBinding.h>
#include <Inventor/nodes/SoPackedColor.h>
#include <Inventor/nodes/SoPointLight.h>
#include <Inventor/nodes/SoScale.h>
#include <Inventor/nodes/SoShaderProgram.h>
#include <Inventor/nodes/SoShapeHints.h>
#include <Inventor/nodes/SoTextureCoordinatePlane.h>
#include <Inventor/nodes/SoVertexShader.h>

using namespace test;

namespace {

Surface hills() { return surfaceOf(fractalMap(97, 65, 30.0)); }

void addMaterials(SoGroup* group, int columns, int rows, SoMaterialBinding::Binding binding, bool packed = false) {
    std::vector<SbColor> colours;
    std::vector<std::uint32_t> packedColours;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            colours.emplace_back(float(column) / float(std::max(1, columns - 1)), 0.5f + 0.4f * std::sin(0.3f * float(row)), 0.2f);
            packedColours.push_back(colours.back().getPackedValue());
        }
    if (packed) {
        auto* node = new SoPackedColor;
        node->orderedRGBA.setValues(0, int(packedColours.size()), packedColours.data());
        group->addChild(node);
    } else {
        auto* node = new SoMaterial;
        node->diffuseColor.setValues(0, int(colours.size()), colours.data());
        group->addChild(node);
    }
    auto* bound = new SoMaterialBinding;
    bound->value = binding;
    group->addChild(bound);
}

}  // namespace

TEST(Normals, OfTheTerrainItselfAreSmooth) {
    expectLikeReference("normals_generated", hills(), {.pixelError = 0.0f, .normals = false}, {}, 0.3, 3.0);
}

TEST(Normals, BoundOverallAreOneForAll) {
    expectLikeReference("normals_overall", hills(), {}, [](SoSeparator* group) {
        auto* binding = new SoNormalBinding;
        binding->value = SoNormalBinding::OVERALL;
        group->addChild(binding);
    }, 0.1, 0.1);
}

TEST(Normals, FollowAScale) {
    expectLikeReference("normals_scaled", hills(), {.pixelError = 0.0f}, [](SoSeparator* group) {
        auto* scale = new SoScale;
        scale->scaleFactor = SbVec3f(1.0f, 1.0f, 0.4f);
        group->addChild(scale);
    }, 0.2, 4.0);
}

TEST(Materials, PerVertexColourTheVertices) {
    const auto dress = [](SoSeparator* group) { addMaterials(group, 97, 65, SoMaterialBinding::PER_VERTEX_INDEXED); };
    expectLikeReference("materials_per_vertex", hills(), {.pixelError = 0.0f}, dress, 0.2, 4.0);
}

TEST(Materials, PerVertexWithoutLightColourTheVertices) {
    expectLikeReference("materials_base_color", hills(), {.pixelError = 0.0f}, [](SoSeparator* group) {
        addMaterials(group, 97, 65, SoMaterialBinding::PER_VERTEX_INDEXED);
        auto* unlit = new SoLightModel;
        unlit->model = SoLightModel::BASE_COLOR;
        group->addChild(unlit);
    }, 0.2, 4.0);
}

TEST(Materials, PackedColoursColourTheVertices) {
    const auto dress = [](SoSeparator* group) { addMaterials(group, 97, 65, SoMaterialBinding::PER_VERTEX_INDEXED, true); };
    expectLikeReference("materials_packed", hills(), {.pixelError = 0.0f}, dress, 0.2, 4.0);
}

TEST(Materials, PerFaceColourLikeAQuadMesh) {
    const auto dress = [](SoSeparator* group) { addMaterials(group, 96, 64, SoMaterialBinding::PER_FACE); };
    expectLikeReference("materials_per_face", hills(), {.pixelError = 0.0f}, dress, 6.0, 6.0, {}, Kind::QuadMesh);
}

TEST(Materials, PerRowColourLikeAQuadMesh) {
    const auto dress = [](SoSeparator* group) { addMaterials(group, 1, 64, SoMaterialBinding::PER_PART); };
    expectLikeReference("materials_per_row", hills(), {.pixelError = 0.0f}, dress, 6.0, 6.0, {}, Kind::QuadMesh);
}

TEST(Materials, TransparencyShowsWhatIsBehind) {
    expectLikeReference("materials_transparent", hills(), {}, [](SoSeparator* group) {
        auto* material = new SoMaterial;
        material->diffuseColor = SbColor(0.2f, 0.8f, 0.3f);
        material->transparency = 0.5f;
        group->addChild(material);
    }, 0.3, 10.0);
}

TEST(Textures, SpanTheTerrainWithoutCoordinates) { expectLikeReference("texture_default", hills(), {}, [](SoSeparator* group) { addTexture(group); }, 0.3, 6.0); }

TEST(Textures, FollowTextureCoordinates) {
    expectLikeReference("texture_coordinates", hills(), {.coordinatesOnUnit = 0}, unlitTexture, 0.3, 3.0);
}

TEST(Textures, OfTwoUnitsMultiply) {
    const auto dress = [](SoSeparator* group) {
        unlitTexture(group);
        addTexture(group, 3, 1);
    };
    expectLikeReference("texture_two_units", hills(), {}, dress, 0.3, 3.0);
    expectLikeReference("texture_two_units_coordinates", hills(), {.coordinatesOnUnit = 1}, dress, 0.3, 3.0);
}

TEST(Textures, FollowACoordinateFunction) {
    // Coordinates of the reference come after the function, so both get it by a plane in front of the shape alone.
    Stage stage;
    std::vector<terrain::Image> pictures;
    for (const Kind kind : {Kind::Reference, Kind::BruteForce, Kind::Roam, Kind::GeoMipmap}) {
        const auto root = sceneOf(kind, hills(), {.pixelError = 0.5f}, unlitTexture);
        auto* dressed = static_cast<SoSeparator*>(root->getChild(2));
        auto* group = static_cast<SoSeparator*>(dressed->getChild(dressed->getNumChildren() - 1));
        auto* plane = new SoTextureCoordinatePlane;
        plane->directionS = SbVec3f(0.01f, 0.0f, 0.0f);
        plane->directionT = SbVec3f(0.0f, 0.005f, 0.03f);
        group->insertChild(plane, group->getNumChildren() - 1);
        pictures.push_back(stage.render(root.get()));
    }
    savePicture("texture_function", pictures);
    expectAlike(pictures[0], pictures[1], 0.3, "brute force");
    expectAlike(pictures[0], pictures[2], 3.0, "ROAM");
    expectAlike(pictures[0], pictures[3], 3.0, "Geo Mip-Mapping");
}

TEST(Lights, FogHidesWhatIsFar) {
    expectLikeReference("fog", hills(), {}, [](SoSeparator* group) {
        auto* fog = new SoEnvironment;
        fog->fogType = SoEnvironment::FOG;
        fog->fogColor = SbColor(0.9f, 0.9f, 1.0f);
        fog->fogVisibility = 250.0f;
        group->addChild(fog);
        unlitTexture(group);
    }, 0.3, 3.0);
}

TEST(Lights, PointLightsLightWhatIsNear) {
    expectLikeReference("point_light", hills(), {.pixelError = 0.0f}, [](SoSeparator* group) {
        auto* light = new SoPointLight;
        light->location = SbVec3f(40.0f, 20.0f, 15.0f);
        light->color = SbColor(1.0f, 0.2f, 0.1f);
        group->addChild(light);
    }, 0.3, 5.0);
}

TEST(ClipPlanes, CutTheTerrain) {
    expectLikeReference("clip_plane", hills(), {}, [](SoSeparator* group) {
        auto* plane = new SoClipPlane;
        plane->plane = SbPlane(SbVec3f(0.6f, 0.8f, 0.0f), 50.0f);
        group->addChild(plane);
        unlitTexture(group);
    }, 0.3, 3.0);
}

TEST(Shaders, OfTheUserColourTheTerrain) {
    expectLikeReference("shader", hills(), {.pixelError = 1.0f}, [](SoSeparator* group) {
        auto* program = new SoShaderProgram;
        auto* vertex = new SoVertexShader;
        vertex->sourceType = SoShaderObject::GLSL_PROGRAM;
        vertex->sourceProgram = "varying float height;\n"
                                "void main() { height = gl_Vertex.z / 30.0; gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex; }\n";
        auto* fragment = new SoFragmentShader;
        fragment->sourceType = SoShaderObject::GLSL_PROGRAM;
        fragment->sourceProgram = "varying float height;\n"
                                  "void main() { gl_FragColor = vec4(height, 1.0 - height, 0.5 + 0.5 * sin(20.0 * height), 1.0); }\n";
        program->shaderObject.set1Value(0, vertex);
        program->shaderObject.set1Value(1, fragment);
        group->addChild(program);
    }, 0.3, 5.0);
}

namespace {

/// The picture with shape hints, from above (1) or below (-1), a light on either side.
terrain::Image hinted(Stage& stage, Kind kind, const Surface& surface, SoShapeHints::VertexOrdering ordering, SoShapeHints::ShapeType type, float side) {
    const SbVec3f centre = surface.box().getCenter();
    return stage.render(sceneOf(kind, surface, {.pixelError = 0.0f}, [&](SoSeparator* group) {
        auto* hints = new SoShapeHints;
        hints->vertexOrdering = ordering;
        hints->shapeType = type;
        group->addChild(hints);
        auto* light = new SoPointLight;
        light->location = SbVec3f(40.0f, 20.0f, -40.0f);
        group->addChild(light);
    }, cameraAt(centre + SbVec3f(0.0f, -40.0f, side * 90.0f), centre, 1.0f, 300.0f)).get());
}

constexpr SoShapeHints::VertexOrdering kOrderings[] = {SoShapeHints::CLOCKWISE, SoShapeHints::COUNTERCLOCKWISE};

}  // namespace

TEST(ShapeHints, ShowTheUpperSideOfSolidGroundAndCullTheLower) {
    Stage stage;
    for (const Kind kind : kOurKinds)
        for (const auto ordering : kOrderings) {
            EXPECT_GT(coveredPixels(hinted(stage, kind, hills(), ordering, SoShapeHints::SOLID, 1.0f)), 10000) << nameOf(kind) << ordering;
            EXPECT_EQ(coveredPixels(hinted(stage, kind, hills(), ordering, SoShapeHints::SOLID, -1.0f)), 0) << nameOf(kind) << ordering;
        }
}

TEST(ShapeHints, CullCurvedGridsAsAQuadMesh) {
    Stage stage;
    const Surface bowl = surfaceOf(mapOf(65, 65, [](double, double) { return 0.0; }), [](int column, int row, float) {
        const float x = float(column) + 0.01f * float(row * row), y = float(row) - 0.005f * float(column * column);
        return SbVec3f(x, y, 0.01f * (x - 32.0f) * (x - 32.0f));
    });
    for (const auto ordering : kOrderings)
        for (const float side : {1.0f, -1.0f}) {
            const auto reference = hinted(stage, Kind::QuadMesh, bowl, ordering, SoShapeHints::SOLID, side);
            for (const Kind kind : kOurKinds) {
                const Difference found = compare(reference, hinted(stage, kind, bowl, ordering, SoShapeHints::SOLID, side));
                EXPECT_EQ(found.onlyFirst + found.onlySecond, 0) << nameOf(kind) << " ordering " << ordering << " side " << side;
            }
        }
}

TEST(ShapeHints, ThatGiveAnOrderLightBothSides) {
    Stage stage;
    for (const float side : {1.0f, -1.0f}) {
        // In this order the upper side is a quad mesh's front, too.
        const auto reference = hinted(stage, Kind::QuadMesh, hills(), SoShapeHints::CLOCKWISE, SoShapeHints::UNKNOWN_SHAPE_TYPE, side);
        for (const Kind kind : kOurKinds)
            for (const auto ordering : kOrderings) {
                const auto found = hinted(stage, kind, hills(), ordering, SoShapeHints::UNKNOWN_SHAPE_TYPE, side);
                expectAlike(reference, found, 6.0, nameOf(kind));
                if (side < 0.0f) savePicture("two_sided_" + identifierOf(kind), {reference, found});
            }
    }
}
