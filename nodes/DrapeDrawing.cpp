#include <epoxy/gl.h>

#include "DrapeDrawing.h"

void DrapeDrawing::fill(const Key & key, const terrain::DrapeSelection & selection, const std::vector<std::uint32_t> & colours)
{
    key_ = key;
    hasContents_ = true;
    hasColours_ = !colours.empty();
    firsts_ = selection.firsts;
    counts_ = selection.counts;
    if (selection.positions.empty()) return;
    positions_.fill(GL_ARRAY_BUFFER, selection.positions.data(), selection.positions.size() * sizeof(glm::vec3));
    if (hasColours_) colours_.fill(GL_ARRAY_BUFFER, colours.data(), colours.size() * sizeof(std::uint32_t));
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void DrapeDrawing::draw(GLenum mode) const
{
    if (firsts_.empty()) return;
    glPushClientAttrib(GL_CLIENT_VERTEX_ARRAY_BIT);
    positions_.current().bind(GL_ARRAY_BUFFER);
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(3, GL_FLOAT, 0, nullptr);
    if (hasColours_) {
        colours_.current().bind(GL_ARRAY_BUFFER);
        glEnableClientState(GL_COLOR_ARRAY);
        glColorPointer(4, GL_UNSIGNED_BYTE, 0, nullptr);
    }
    glMultiDrawArrays(mode, firsts_.data(), counts_.data(), GLsizei(firsts_.size()));
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glPopClientAttrib();
}

std::vector<terrain::GlName> DrapeDrawing::release()
{
    std::vector<terrain::GlName> names;
    for (terrain::GlStream * stream : {&positions_, &colours_})
        for (terrain::GlBuffer & buffer : stream->all())
            if (const GLuint name = buffer.release()) names.push_back({terrain::GlName::Buffer, name});
    hasContents_ = false;
    return names;
}
