#include "gl/DetailShader.h"

namespace terrain {

// Sums are in the order of SynthesisedDetail.cpp, and all products exact: it does not matter whether they are fused.
const char* detailShaderSource() {
    return R"(
uniform sampler2D detailNoiseTable;
uniform uint detailSeed;

float coarserHeightAt(ivec2 vertex);

const float detailNoiseScale[9] = float[9](2.0, 1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125, 0.015625, 0.0078125);

// pcg3d of Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020.
float detailNoise(ivec2 vertex, int level)
{
    uvec3 v = uvec3(uvec2(vertex), detailSeed + uint(level) * 0x9E3779B9u) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    return texelFetch(detailNoiseTable, ivec2(int((v.x >> 16u) & 1023u), 0), 0).r * detailNoiseScale[level];
}

float detailFourPoint(float a, float b, float c, float d)
{
    if (isnan(a)) a = b;
    if (isnan(d)) d = c;
    float inner = b + c;
    return 0.5 * inner + 0.0625 * (inner - (a + d));
}

float detailAlongRow(int k, int row, int last)
{
    return detailFourPoint(coarserHeightAt(ivec2(max(k - 1, 0), row)), coarserHeightAt(ivec2(k, row)),
                           coarserHeightAt(ivec2(k + 1, row)), coarserHeightAt(ivec2(min(k + 2, last), row)));
}

float detailPrediction(ivec2 vertex, ivec2 lastCoarser)
{
    ivec2 k = vertex >> 1;
    bool oddColumn = (vertex.x & 1) != 0, oddRow = (vertex.y & 1) != 0;
    int before = max(k.y - 1, 0), after = min(k.y + 2, lastCoarser.y);
    if (!oddRow) return oddColumn ? detailAlongRow(k.x, k.y, lastCoarser.x) : coarserHeightAt(k);
    if (!oddColumn)
        return detailFourPoint(coarserHeightAt(ivec2(k.x, before)), coarserHeightAt(k), coarserHeightAt(ivec2(k.x, k.y + 1)),
                               coarserHeightAt(ivec2(k.x, after)));
    return detailFourPoint(detailAlongRow(k.x, before, lastCoarser.x), detailAlongRow(k.x, k.y, lastCoarser.x),
                           detailAlongRow(k.x, k.y + 1, lastCoarser.x), detailAlongRow(k.x, after, lastCoarser.x));
}

float detailHeight(ivec2 vertex, int level, ivec2 lastCoarser)
{
    float height = detailPrediction(vertex, lastCoarser);
    return ((vertex.x | vertex.y) & 1) == 0 ? height : height + detailNoise(vertex, level);
}
)";
}

GLuint makeNoiseTexture(const SynthesisedDetail& detail) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, SynthesisedDetail::kNoiseValues, 1, 0, GL_RED, GL_FLOAT, detail.noiseTable().data());
    return texture;
}

void setDetailUniforms(GLuint program, const SynthesisedDetail& detail, int unit) {
    glUniform1i(glGetUniformLocation(program, "detailNoiseTable"), unit);
    glUniform1ui(glGetUniformLocation(program, "detailSeed"), detail.seed());
}

}  // namespace terrain
