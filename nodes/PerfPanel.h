// Where graphs lie in a viewport, and what they consist of.
#ifndef SOTERRAIN_PERFPANEL_H
#define SOTERRAIN_PERFPANEL_H

#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "PerfPlot.h"
#include "gl/Overlay.h"

/// Lengths are in pixels of the viewport.
struct PerfLayout {
    glm::vec2 position;  ///< of the first graph's corner; from the right or upper border where it is negative
    glm::vec2 size;      ///< of a graph
    glm::vec2 viewport;
    float gap = 6.0f;  ///< between graphs
    int columns = 0;   ///< 0: as many as fit
    int textScale = 1;

    /// Gives graphs that are wider or higher than the viewport its size.
    void fit();
    glm::vec2 cornerOf(int graph) const;
};

struct PerfGraphStyle {
    terrain::OverlayColor color, ground;
};

/// A graph in a layout: name and value on top, below them the curve, over its whole width, with the ends of its scale.
class PerfGraphPicture {
public:
    PerfGraphPicture(const PerfLayout & layout, int graph);

    void addGround(terrain::OverlayQuads & to, const PerfPlot & plot, const PerfGraphStyle & style) const;
    void addText(terrain::OverlayQuads & to, const PerfPlot & plot, const PerfGraphStyle & style, const std::string & name,
                 const std::string & unit) const;
    /// Appends the vertices of its curve, and returns how many these are.
    int addCurve(std::vector<terrain::OverlayVertex> & curves, const PerfPlot & plot, const terrain::OverlayColor & color) const;

private:
    float heightOf(double value, const PerfPlot & plot) const;

    glm::vec2 low_, high_;
    float curveTop_;  ///< below the text on top, where there is room for both
    int textScale_;
};

#endif
