#include "gl/GlProgram.h"

#include <optional>

namespace terrain {

namespace {

/// The first lines of a log, which is where the cause stands.
std::string oneLine(std::string log) {
    constexpr std::size_t kMost = 300;
    for (char& c : log)
        if (c == '\n' || c == '\0') c = ' ';
    while (!log.empty() && log.back() == ' ') log.pop_back();
    return log.substr(0, kMost);
}

Result<GLuint> compile(const std::string& what, GLenum stage, const std::string& source) {
    const GLuint shader = glCreateShader(stage);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint done = 0, length = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (done) return shader;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(std::size_t(length), ' ');
    glGetShaderInfoLog(shader, length, nullptr, log.data());
    glDeleteShader(shader);
    return Error{what, "an OpenGL that compiles its shaders", oneLine(log)};
}

}  // namespace

void deleteNames(std::span<const GlName> names) {
    for (const GlName& object : names) switch (object.kind) {
        case GlName::Buffer:
            glDeleteBuffers(1, &object.name);
            break;
        case GlName::Texture:
            glDeleteTextures(1, &object.name);
            break;
        case GlName::Program:
            glDeleteProgram(object.name);
            break;
        }
}

Result<GlProgram> GlProgram::build(const std::string& what, const std::string& vertexShader, const std::string& fragmentShader,
                                   const std::vector<std::pair<const char*, GLuint>>& attributes) {
    std::vector<GLuint> shaders;
    const auto add = [&](GLenum stage, const std::string& source) -> std::optional<Error> {
        auto shader = compile(what, stage, source);
        if (!shader) return shader.error();
        shaders.push_back(shader.value());
        return std::nullopt;
    };
    std::optional<Error> problem;
    if (!vertexShader.empty()) problem = add(GL_VERTEX_SHADER, vertexShader);
    if (!problem) problem = add(GL_FRAGMENT_SHADER, fragmentShader);
    GlProgram program;
    if (!problem) program.name_ = glCreateProgram();
    for (const GLuint shader : shaders) {
        if (!problem) glAttachShader(program.name_, shader);
        // It goes with the program.
        glDeleteShader(shader);
    }
    if (problem) return *problem;
    for (const auto& [name, place] : attributes) glBindAttribLocation(program.name_, place, name);
    glLinkProgram(program.name_);
    GLint done = 0, length = 0;
    glGetProgramiv(program.name_, GL_LINK_STATUS, &done);
    if (done) return program;
    glGetProgramiv(program.name_, GL_INFO_LOG_LENGTH, &length);
    std::string log(std::size_t(length), ' ');
    glGetProgramInfoLog(program.name_, length, nullptr, log.data());
    glDeleteProgram(program.release());
    return Error{what, "an OpenGL that links its shaders", oneLine(log)};
}

GLint GlProgram::operator[](const char* uniform) {
    for (const auto& [known, place] : places_)
        if (known == uniform) return place;
    return places_.emplace_back(uniform, glGetUniformLocation(name_, uniform)).second;
}

}  // namespace terrain
