// docs/actions.md says what is tested, no more and no less.
#include "Actions.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

using namespace test;

namespace {

/// Tests of the suites for actions: the name without a parameter, and for what nodes it is.
std::map<std::string, std::set<std::string>> testsThatAre() {
    std::map<std::string, std::set<std::string>> all;
    const auto& unit = *testing::UnitTest::GetInstance();
    for (int i = 0; i < unit.total_test_suite_count(); ++i) {
        const testing::TestSuite& suite = *unit.GetTestSuite(i);
        const std::string name = suite.name();
        if (name.rfind("Action", 0) != 0 || name == "ActionTable") continue;
        for (int k = 0; k < suite.total_test_count(); ++k) {
            const std::string test = suite.GetTestInfo(k)->name();
            const std::size_t slash = test.find('/');
            all[name + '.' + test.substr(0, slash)].insert(slash == std::string::npos ? "" : test.substr(slash + 1));
        }
    }
    return all;
}

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(' ');
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Rows of the table whose last cell names a test: the cells between what it does and that.
std::map<std::string, std::vector<std::string>> rowsOfTheDocument() {
    std::map<std::string, std::vector<std::string>> rows;
    const char* source = std::getenv("SOTERRAIN_SRCDIR");
    std::ifstream file(std::string(source ? source : ".") + "/docs/actions.md");
    for (std::string line; std::getline(file, line);) {
        if (line.rfind("| ", 0) != 0) continue;
        std::vector<std::string> cells;
        std::stringstream row(line.substr(1));
        for (std::string cell; std::getline(row, cell, '|');) cells.push_back(trimmed(cell));
        const std::string test = cells.back();
        if (test.rfind("`Action", 0) == 0) rows[test.substr(1, test.size() - 2)] = {cells.begin() + 1, cells.end() - 1};
    }
    return rows;
}

}  // namespace

TEST(ActionTable, OfTheDocumentHasARowForEachTestAndATestForEachRow) {
    const auto tests = testsThatAre();
    const auto rows = rowsOfTheDocument();
    ASSERT_FALSE(rows.empty()) << "docs/actions.md is not there or has no table";
    for (const auto& [test, nodes] : tests) EXPECT_TRUE(rows.count(test)) << test << " has no row in docs/actions.md";
    for (const auto& [test, cells] : rows) {
        ASSERT_TRUE(tests.count(test)) << "docs/actions.md names " << test << ", which is no test";
        ASSERT_EQ(cells.size(), std::size(kOurKinds)) << test;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            EXPECT_EQ(cells[i].rfind("yes", 0), 0u) << test << ": " << nameOf(kOurKinds[i]);
            if (tests.at(test).count("")) continue;
            for (const char* over : {"OverCoordinates", "OverHeightMap"})
                EXPECT_TRUE(tests.at(test).count(identifierOf(kOurKinds[i]) + over)) << test << ": " << nameOf(kOurKinds[i]) << ' ' << over;
        }
    }
}
