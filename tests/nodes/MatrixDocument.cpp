// docs/compatibility.md from the table.
#include "Matrix.h"

#include <cstdio>

namespace test::matrix {

namespace {

const char* const kHead = R"(# What Coin's properties do to the terrain nodes

Every row is a test of every node: `tests/test_nodes --gtest_filter='*MatrixCell*'` draws 65 x 65 samples in a picture of 160 x 120 pixels with
the node at `pixelError 0`, and compares it with the same scene with Coin's own shape at full detail, drawn in the same run: SoIndexedFaceSet, or
SoQuadMesh where bindings count cells and rows. Both pictures have to cover the same pixels, but for a rim of two.

The number is how far the colours of the two may be apart: the mean absolute difference of a channel over the covered pixels, of 255. For lines and
points (≈) it is that of averages over 8 x 8 pixels, in all of the picture. What differs at all are the diagonals of cells, which nodes
with level of detail choose differently, and light, which a geometry clipmap works out for each pixel and not for each vertex.
`*MatrixProperty*` checks that each property changes the reference, so that no row passes because nothing happens; rows marked "no effect" must
change nothing.

SoGeometryClipmapTerrain stands for `implementation` AUTO: where the number has no mark the GPU draws, with CPU it draws vertex arrays, for the reason
in the last column. `implementation GPU` says the same in a warning.

The pictures have a line for each row, in order: SoIndexedFaceSet, then the nodes in the order of the columns.

)";

const char* const kTail = R"(## Made by

This file is what `tests/nodes/Matrix*.cpp` say, and a test compares it with them (`Matrix.IsWhatTheDocsSay`, which writes the right text to the build
folder where it differs). The pictures are made anew, and the differences of this machine printed, by

    SOTERRAIN_CONTACT_SHEETS=. tests/test_nodes --gtest_filter='MatrixSheets.*'
    mogrify -format jpg -resize 62% -quality 60 -sampling-factor 4:2:0 matrix-*.png
)";

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

std::string remarks(const Property& property) {
    std::string text = property.effect == Effect::None ? "no effect" : "";
    const auto add = [&text](const std::string& more) {
        if (!more.empty()) text += (text.empty() ? "" : "; ") + more;
    };
    if (property.reference == Reference::QuadMesh) add("reference SoQuadMesh");
    if (property.reference == Reference::ClockwiseFaceSet) add("reference with clockwise faces");
    if (!property.arrays.empty()) add("CPU: " + property.arrays);
    add(property.note);
    return text;
}

std::string rowOf(const Property& property) {
    std::string text = "| " + property.name + " |";
    for (const Column column : kColumns) {
        text += property.measure == Measure::Areas ? " ≈" : " ";
        text += number(property.toleranceOf(column));
        if (column == Column::Clipmap && !property.arrays.empty()) text += " CPU";
        text += " |";
    }
    return text + " " + remarks(property) + " |\n";
}

}  // namespace

std::string documentText() {
    std::string text = kHead;
    for (const Group& group : groups()) {
        text += "## " + group.name + "\n\n| property |";
        for (const Column column : kColumns) text += " " + nameOf(column) + " |";
        text += " |\n|---|";
        for (std::size_t i = 0; i < std::size(kColumns); ++i) text += "---|";
        text += "---|\n";
        for (const Property& property : group.properties) text += rowOf(property);
        if (!group.leftOut.empty()) text += "\n| left out | why |\n|---|---|\n";
        for (const auto& [name, reason] : group.leftOut) text += "| " + name + " | " + reason + " |\n";
        text += "\n![" + group.name + "](pictures/matrix-" + group.identifier + ".jpg)\n\n";
    }
    return text + kTail;
}

}  // namespace test::matrix
