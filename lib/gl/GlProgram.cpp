#include "gl/GlProgram.h"

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
    const auto vertex = compile(what, GL_VERTEX_SHADER, vertexShader);
    if (!vertex) return vertex.error();
    const auto fragment = compile(what, GL_FRAGMENT_SHADER, fragmentShader);
    if (!fragment) {
        glDeleteShader(vertex.value());
        return fragment.error();
    }
    GlProgram program;
    program.name_ = glCreateProgram();
    for (const GLuint shader : {vertex.value(), fragment.value()}) {
        glAttachShader(program.name_, shader);
        // It goes with the program.
        glDeleteShader(shader);
    }
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
    const auto known = places_.find(uniform);
    if (known != places_.end()) return known->second;
    return places_[uniform] = glGetUniformLocation(name_, uniform);
}

}  // namespace terrain
