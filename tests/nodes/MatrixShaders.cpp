// Shader programs and shadows of the matrix.
#include "Matrix.h"

namespace test::matrix {

namespace {

std::string shader(const char* type, const std::string& source, const std::string& parameters = {}) {
    return std::string(type) + "Shader { sourceType GLSL_PROGRAM sourceProgram \"" + source + "\" " + parameters + " }\n";
}

std::string program(const std::string& objects) {
    return "ShaderProgram { shaderObject [ " + objects + " ] }\n";
}

const char* const kVertex =
    "varying float height; void main() { height = gl_Vertex.z / 20.0; gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex; }";

std::string shadows(const std::string& fields, const std::string& light, const std::string& style) {
    return "ShadowGroup { " + fields + light + " ShadowStyle { style " + style +
           " } USE GROUND ShadowStyle { style CASTS_SHADOW_AND_SHADOWED }\n"
           "Separator { Material { diffuseColor 0.9 0.3 0.2 } Translation { translation 26 22 24 } Sphere { radius 6 } }\n"
           "Separator { Material { diffuseColor 0.3 0.3 0.9 } Translation { translation 32 60 10 } Cube { width 60 height 2 depth "
           "30 } } }";
}

}  // namespace

Group shaders() {
    std::vector<Property> rows;
    const std::string active = "an SoShaderProgram is active";
    const std::string striped = "varying float height; uniform float stripes; uniform vec3 colour; void main() { gl_FragColor = "
                                "vec4(colour * (0.6 + 0.4 * sin(stripes * height)), 1.0); }";
    rows.push_back({.name = "ShaderProgram: vertex and fragment shader, parameters",
                    .iv = program(shader("Vertex", kVertex) + shader("Fragment", striped,
                                                                     "parameter [ ShaderParameter1f { name \"stripes\" value 8 }, "
                                                                     "ShaderParameter3f { name \"colour\" value 1 0.8 0.3 } ]")),
                    .arrays = active});
    rows.push_back({.name = "ShaderProgram: texture, normals and lights",
                    .iv = program(shader("Vertex", "varying float light; void main() { light = max(dot(gl_NormalMatrix * "
                                                   "gl_Normal, normalize(gl_LightSource[0].position.xyz)), 0.0); gl_TexCoord[0] = "
                                                   "gl_MultiTexCoord0; gl_Position = ftransform(); }") +
                                  shader("Fragment",
                                         "varying float light; uniform sampler2D image; void main() { gl_FragColor = vec4(light * "
                                         "texture2D(image, gl_TexCoord[0].st).rgb, 1.0); }",
                                         "parameter [ ShaderParameter1i { name \"image\" value 0 } ]")),
                    .base = "Texture2 { " + imageText(3) + " }",
                    .arrays = active});
    rows.push_back({.name = "ShaderProgram: colours per vertex",
                    .iv = program(shader("Vertex", "void main() { gl_FrontColor = gl_Color.gbra; gl_Position = ftransform(); }") +
                                  shader("Fragment", "void main() { gl_FragColor = gl_Color; }")),
                    .base = "Material { diffuseColor 0.9 0.5 0.1 }",
                    .arrays = active});
    rows.push_back(
        {.name = "ShaderProgram: moved vertices",
         .iv = program(shader("Vertex", "void main() { vec4 p = gl_Vertex; p.z += 4.0 * sin(0.3 * p.x); gl_FrontColor = vec4(p.x / "
                                        "64.0, p.y / 64.0, 0.3, 1.0); gl_Position = gl_ModelViewProjectionMatrix * p; }") +
                       shader("Fragment", "void main() { gl_FragColor = gl_Color; }")),
         .arrays = active,
         .note = "frustumCulling knows nothing of what a shader moves; the ground here is all in view"});
    rows.push_back({.name = "ShaderProgram: vertex shader alone",
                    .iv = program(shader(
                        "Vertex", "void main() { gl_FrontColor = vec4(gl_Normal * 0.5 + 0.5, 1.0); gl_Position = ftransform(); }")),
                    .arrays = active});
    rows.push_back({.name = "ShaderProgram: fragment shader alone",
                    .iv = program(shader("Fragment", "void main() { gl_FragColor = vec4(1.0 - gl_Color.rgb, 1.0); }")),
                    .arrays = active});
    const std::string dark = "Info { }", spot = "SpotLight { location -25 -10 42 direction 0.8 0.6 -0.45 cutOffAngle 0.7 }";
    for (const std::string style : {"CASTS_SHADOW_AND_SHADOWED", "CASTS_SHADOW", "SHADOWED", "NO_SHADOWING"})
        rows.push_back({.name = "ShadowGroup, ShadowStyle " + style,
                        .iv = shadows("quality 1 precision 1 ", spot, style),
                        .lights = dark,
                        .arrays = active});
    rows.push_back({.name = "ShadowGroup: isActive FALSE",
                    .iv = shadows("isActive FALSE ", spot, "CASTS_SHADOW_AND_SHADOWED"),
                    .lights = dark});
    return {
        "Shaders and shadows",
        "shaders",
        rows,
        {{"SoVertexAttribute", "terrain nodes send positions, normals, colours and texture coordinates to a shader, and no further "
                               "attributes; each texture unit has room for four numbers"},
         {"SoShadowDirectionalLight",
          "Coin 4.0.0 draws all of the reference in shadow under Mesa, its own shapes alone as well; spot lights stand for it"}}};
}

}  // namespace test::matrix
