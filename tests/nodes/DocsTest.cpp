// What the class documentation says of fields is what the classes have.
#include "Harness.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <Inventor/SbName.h>
#include <Inventor/SbString.h>
#include <Inventor/SoType.h>
#include <Inventor/fields/SoField.h>
#include <Inventor/fields/SoSFNode.h>
#include <Inventor/fields/SoSFUInt32.h>
#include <Inventor/lists/SoFieldList.h>
#include <Inventor/nodekits/SoBaseKit.h>
#include <Inventor/nodekits/SoNodekitCatalog.h>

namespace {

std::string sourceFolder() {
    const char* folder = std::getenv("SOTERRAIN_SRCDIR");
    return folder ? folder : ".";
}

std::string read(const std::string& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// NODE_CLASSES of Makefile.am.
std::vector<std::string> nodeClasses() {
    const std::string text = read(sourceFolder() + "/Makefile.am");
    std::smatch list;
    std::vector<std::string> classes;
    if (!std::regex_search(text, list, std::regex("\nNODE_CLASSES =((?: *\\\\\n|[ \t]+|\\w+)*)"))) return classes;
    const std::string words = list[1];
    const std::regex word("\\w+");
    for (std::sregex_iterator i(words.begin(), words.end(), word), end; i != end; ++i) classes.push_back(i->str());
    return classes;
}

/// Lines "name value" between the braces under FILE FORMAT/DEFAULTS.
std::vector<std::string> documented(const std::string& className) {
    const std::string text = read(sourceFolder() + "/nodes/" + className + ".cpp");
    std::vector<std::string> lines;
    std::size_t at = text.find("FILE FORMAT/DEFAULTS");
    if (at == std::string::npos) return lines;
    at = text.find(className + " {\n", at);
    if (at == std::string::npos) return lines;
    std::istringstream rest(text.substr(text.find('\n', at) + 1));
    for (std::string line; std::getline(rest, line) && line != "    }";)
        lines.push_back(std::regex_replace(line, std::regex("^\\s+|\\s+$"), ""));
    return lines;
}

std::string nameOf(const SoNode* node) {
    return node ? std::string(node->getTypeId().getName().getString()) + " { }" : "NULL";
}

/// Parts of a kit that nobody sets by name.
bool isPrivatePart(SoNode* node, const SbName& name) {
    if (!node->isOfType(SoBaseKit::getClassTypeId())) return false;
    const SoNodekitCatalog* catalog = static_cast<SoBaseKit*>(node)->getNodekitCatalog();
    const int part = catalog->getPartNumber(name);
    return part > 0 && !catalog->isPublic(part);
}

/// On one line, and numbers as people write them: 0.4 rather than 0.40000001.
std::string asWritten(const std::string& value) {
    static const std::regex number("-?[0-9]+\\.[0-9]{6,}");
    const std::string line = std::regex_replace(value, std::regex("\\s+"), " ");
    std::string text;
    auto rest = line.cbegin();
    for (std::sregex_iterator i(line.begin(), line.end(), number), end; i != end; ++i) {
        char rounded[32];
        std::snprintf(rounded, sizeof rounded, "%.6g", std::stod((*i)[0]));
        text.append(rest, (*i)[0].first).append(rounded);
        rest = (*i)[0].second;
    }
    return text.append(rest, line.cend());
}

/// The same of a new node: its fields in the order in which they are written, with their defaults; numbers are decimal. A node that
/// a kit makes is as it is written, "Class { }".
std::vector<std::string> actual(SoNode* node) {
    std::vector<std::string> lines;
    SoFieldList fields;
    node->getFields(fields);
    for (int i = 0; i < fields.getLength(); ++i) {
        SbName name;
        node->getFieldName(fields[i], name);
        if (isPrivatePart(node, name)) continue;
        SbString value;
        fields[i]->get(value);
        std::string text = asWritten(value.getString());
        if (fields[i]->isOfType(SoSFNode::getClassTypeId())) text = nameOf(static_cast<SoSFNode*>(fields[i])->getValue());
        if (fields[i]->isOfType(SoSFUInt32::getClassTypeId())) text = std::to_string(static_cast<SoSFUInt32*>(fields[i])->getValue());
        if (text == "[  ]") text = "[ ]";
        if (text == "nan" || text == "-nan") text = "NaN";
        lines.push_back(std::string(name.getString()) + " " + text);
    }
    return lines;
}

class ClassDocs : public testing::TestWithParam<std::string> {};

TEST_P(ClassDocs, ListTheFieldsInOrderWithTheirDefaults) {
    const SoType type = SoType::fromName(GetParam().c_str());
    ASSERT_FALSE(type.isBad()) << "no such class";
    if (!type.canCreateInstance()) {
        EXPECT_TRUE(documented(GetParam()).empty()) << "nothing can be written of an abstract class";
        return;
    }
    const test::Ref<SoNode> node(static_cast<SoNode*>(type.createInstance()));
    EXPECT_EQ(documented(GetParam()), actual(node.get()));
}

/// The part of docs/fields.md under this heading; empty where there is none.
std::string table(const std::string& heading) {
    const std::string text = read(sourceFolder() + "/docs/fields.md"), start = "\n## " + heading + "\n";
    const std::size_t at = text.find(start);
    return at == std::string::npos ? "" : text.substr(at, text.find("\n## ", at + 1) - at);
}

/// Readers look a field up in one place.
TEST_P(ClassDocs, FieldsHaveAPlaceInTheTables) {
    const SoType type = SoType::fromName(GetParam().c_str());
    if (!type.canCreateInstance()) return;
    const test::Ref<SoNode> node(static_cast<SoNode*>(type.createInstance()));
    SoFieldList fields;
    node->getFields(fields);
    const bool isShape = type.isDerivedFrom(SoType::fromName("SoTerrainShape"));
    const std::string listed = table(GetParam()) + (isShape ? table("Every terrain node") : "");
    for (int i = 0; i < fields.getLength(); ++i) {
        SbName name;
        node->getFieldName(fields[i], name);
        if (node->isOfType(SoBaseKit::getClassTypeId()) && (isPrivatePart(node.get(), name) || name == "callbackList")) continue;
        EXPECT_NE(listed.find(std::string("`") + name.getString() + "`"), std::string::npos) << name.getString();
    }
}

/// "Default 2." or the like stands in the text of each field that the class adds itself; so it can't say another number than the block.
TEST_P(ClassDocs, NameTheDefaultOfEachFieldOfTheirOwn) {
    const std::string text = read(sourceFolder() + "/nodes/" + GetParam() + ".cpp");
    const std::regex entry("\\\\var So[SM]F\\w+ " + GetParam() + "::(\\w+)\n((?:(?!\\*/)[^])*?)\\*/");
    int entries = 0;
    for (std::sregex_iterator i(text.begin(), text.end(), entry), end; i != end; ++i) {
        ++entries;
        EXPECT_TRUE(std::regex_search((*i)[2].str(), std::regex("[Dd]efault"))) << (*i)[1] << ": " << (*i)[2];
    }
    EXPECT_GT(entries + int(GetParam() == "SoBruteForceTerrain"), 0);
}

INSTANTIATE_TEST_SUITE_P(Of, ClassDocs, testing::ValuesIn(nodeClasses()), [](const auto& info) { return info.param; });

}  // namespace
