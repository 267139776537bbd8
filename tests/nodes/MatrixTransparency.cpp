// Transparency types of the matrix, by material and by texture.
#include "Matrix.h"

#include <Inventor/actions/SoGLRenderAction.h>

namespace test::matrix {

namespace {

/// The ground over an opaque sheet and a ball that are drawn before it, and around a block that is drawn after it.
std::string between(const std::string& nodes) {
    return "Separator { Material { diffuseColor 0.2 0.5 0.5 } Translation { translation 32 32 -4 } Cube { width 90 height 90 depth "
           "1 } }\n"
           "Separator { Material { diffuseColor 0.8 0.3 0.2 } Translation { translation 18 16 0 } Sphere { radius 9 } }\n"
           "Separator { " +
           nodes +
           "USE GROUND }\n"
           "Separator { Material { diffuseColor 0.2 0.4 0.9 } Translation { translation 40 30 8 } Cube { width 12 height 12 depth "
           "12 } }\n";
}

}  // namespace

Group transparency() {
    std::vector<Property> rows;
    const char* const types[] = {"NONE",
                                 "SCREEN_DOOR",
                                 "ADD",
                                 "DELAYED_ADD",
                                 "SORTED_OBJECT_ADD",
                                 "SORTED_OBJECT_SORTED_TRIANGLE_ADD",
                                 "BLEND",
                                 "DELAYED_BLEND",
                                 "SORTED_OBJECT_BLEND",
                                 "SORTED_OBJECT_SORTED_TRIANGLE_BLEND"};
    for (const std::string type : types) {
        const std::string node = "TransparencyType { value " + type + " }\n";
        rows.push_back({.name = "TransparencyType " + type,
                        .iv = "Separator { " + between(node + "Material { diffuseColor 0.3 0.7 0.3 transparency 0.5 }\n") + " }"});
    }
    for (const std::string type : types) {
        const std::string node = "TransparencyType { value " + type + " }\n";
        rows.push_back({.name = "Texture2 with alpha, TransparencyType " + type,
                        .iv = "Separator { " + between(node + "Texture2 { " + imageText(4) + " }") + " }"});
    }
    rows.push_back({.name = "SoGLRenderAction: SORTED_LAYERS_BLEND",
                    .iv = "Separator { " + between("Material { diffuseColor 0.3 0.7 0.3 transparency 0.5 }\n") + " }",
                    .arrays = "the transparency type draws by a fragment program",
                    .draw = [](Stage& stage, SoSeparator* root) {
                        stage.action().setTransparencyType(SoGLRenderAction::SORTED_LAYERS_BLEND);
                        return stage.render(root);
                    }});
    return {"Transparency", "transparency", rows};
}

}  // namespace test::matrix
