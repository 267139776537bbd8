// Every cell of the matrix, and its document.
#include "Matrix.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "ImageFile.h"

using namespace test;
using namespace test::matrix;
using terrain::Image;

namespace {

struct Cell {
    const Property* property;
    Column column;
};

void PrintTo(const Cell& cell, std::ostream* out) {
    *out << cell.property->name << ", " << matrix::nameOf(cell.column);
}

std::vector<Cell> cells() {
    std::vector<Cell> all;
    for (const Group& group : groups())
        for (const Property& property : group.properties)
            for (const Column column : kColumns) all.push_back({&property, column});
    return all;
}

std::vector<const Property*> properties() {
    std::vector<const Property*> all;
    for (const Group& group : groups())
        for (const Property& property : group.properties) all.push_back(&property);
    return all;
}

/// Cells of a row come one after the other, so one row at a time is kept.
Row& rowOf(const Property& property) {
    static const Property* current = nullptr;
    static std::unique_ptr<Row> row;
    if (current != &property) {
        row.reset();
        row = std::make_unique<Row>(property);
        current = &property;
    }
    return *row;
}

class MatrixCell : public testing::TestWithParam<Cell> {};
class MatrixProperty : public testing::TestWithParam<const Property*> {};

/// What a property must change of the picture to count as visible, over all pixels.
constexpr double kVisible = 1.0;

}  // namespace

TEST_P(MatrixCell, LooksLikeCoinsOwnShape) {
    const Property& property = *GetParam().property;
    Row& row = rowOf(property);
    const Image picture = row.picture(GetParam().column);
    const double tolerance = property.toleranceOf(GetParam().column);
    if (property.measure == Measure::Pixels)
        expectAlike(row.reference(), picture, tolerance, property.name);
    else
        EXPECT_LE(differenceOf(property, row.reference(), picture), tolerance) << property.name;
    if (GetParam().column == Column::Clipmap) {
        const std::string said = row.messageForGpu();
        if (property.arrays.empty())
            EXPECT_EQ(said, "") << "the GPU draws";
        else
            EXPECT_NE(said.find(property.arrays), std::string::npos) << said;
    }
    if (HasFailure())
        savePicture("matrix_" + property.identifier() + '_' + matrix::identifierOf(GetParam().column),
                    {row.without(), row.reference(), picture});
}

TEST_P(MatrixProperty, ShowsInTheReference) {
    const Property& property = *GetParam();
    Row& row = rowOf(property);
    const double difference = meanOverAll(row.without(), row.reference());
    if (property.effect == Effect::Shows)
        EXPECT_GT(difference, kVisible) << property.name;
    else
        EXPECT_LT(difference, 0.1) << property.name;
    if (HasFailure()) savePicture("matrix_" + property.identifier(), {row.without(), row.reference()});
}

INSTANTIATE_TEST_SUITE_P(, MatrixCell, testing::ValuesIn(cells()), [](const auto& info) {
    return info.param.property->identifier() + "_" + matrix::identifierOf(info.param.column);
});

INSTANTIATE_TEST_SUITE_P(, MatrixProperty, testing::ValuesIn(properties()),
                         [](const auto& info) { return info.param->identifier(); });

TEST(Matrix, IsWhatTheDocsSay) {
    const char *source = std::getenv("SOTERRAIN_SRCDIR"), *build = std::getenv("SOTERRAIN_BUILDDIR");
    if (!source) GTEST_SKIP() << "SOTERRAIN_SRCDIR is not set";
    std::stringstream found;
    found << std::ifstream(std::string(source) + "/docs/compatibility.md").rdbuf();
    if (found.str() == documentText()) return;
    const std::string path = std::string(build ? build : ".") + "/compatibility.md";
    std::ofstream(path) << documentText();
    FAIL() << "docs/compatibility.md is not what the table gives; " << path << " is";
}

/// Not a test of its own: writes the pictures of docs/compatibility.md, and prints how far each cell is from the reference.
TEST(MatrixSheets, AreMadeWhereTheyAreAskedFor) {
    const char* folder = std::getenv("SOTERRAIN_CONTACT_SHEETS");
    if (!folder) GTEST_SKIP() << "SOTERRAIN_CONTACT_SHEETS is not set";
    for (const Group& group : groups()) {
        Image sheet;
        for (const Property& property : group.properties) {
            Row row(property);
            std::vector<Image> pictures{row.reference()};
            for (const Column column : kColumns) pictures.push_back(row.picture(column));
            std::printf("%-60s %6.2f |", property.name.c_str(), meanOverAll(row.without(), row.reference()));
            for (std::size_t i = 1; i < pictures.size(); ++i)
                std::printf(" %6.2f", differenceOf(property, row.reference(), pictures[i]));
            std::printf(" | %s", row.messageForGpu().c_str());
            if (property.arrays.empty()) std::printf("\n");
            std::fflush(stdout);
            sheet.width = int(pictures.size()) * pictures.front().width;
            for (int y = 0; y < pictures.front().height; ++y)
                for (const Image& picture : pictures) {
                    const auto row = picture.pixels.begin() + std::ptrdiff_t(y) * picture.width * 3;
                    sheet.pixels.insert(sheet.pixels.end(), row, row + picture.width * 3);
                }
            sheet.height += pictures.front().height;
        }
        if (const auto error = app::writeImage(std::string(folder) + "/matrix-" + group.identifier + ".png", sheet))
            ADD_FAILURE() << error->message();
    }
}
