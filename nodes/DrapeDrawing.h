// The buffers of draped lines in one view.
#ifndef SOTERRAIN_DRAPEDRAWING_H
#define SOTERRAIN_DRAPEDRAWING_H

#include <cstdint>
#include <memory>
#include <vector>

#include "TerrainViews.h"
#include "base/View.h"
#include "gl/GlObjects.h"
#include "lod/DrapeView.h"

class DrapeDrawing : public ViewDrawing {
public:
    /// What the vertices depend on.
    struct Key {
        std::shared_ptr<const void> lines;
        terrain::View camera;
        terrain::DrapeSettings settings;
        std::uint64_t colours = 0;

        bool operator==(const Key & other) const = default;
    };

    bool isCurrent(const Key & key) const { return hasContents_ && key == key_; }
    /// `colours`: RGBA by vertex, or empty.
    void fill(const Key & key, const terrain::DrapeSelection & selection, const std::vector<std::uint32_t> & colours);
    void draw(GLenum mode) const;

    bool isThere() const override { return positions_.current().isThere() && colours_.current().isThere(); }
    std::vector<terrain::GlName> release() override;
    std::size_t memoryBytes() const override { return firsts_.capacity() * 2 * sizeof(int); }
    std::size_t bufferBytes() const override { return positions_.bytes() + colours_.bytes(); }

private:
    Key key_;
    bool hasContents_ = false;
    bool hasColours_ = false;
    terrain::GlStream positions_, colours_;
    std::vector<int> firsts_, counts_;
};

#endif
