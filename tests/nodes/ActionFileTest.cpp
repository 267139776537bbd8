// Every node is written and read with all of its fields, by programs with and without the library.
#include "Actions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <Inventor/SoLists.h>
#include <Inventor/engines/SoCalculator.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/fields/SoFields.h>
#include <Inventor/misc/SoChildList.h>
#include <Inventor/nodes/SoCube.h>

#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoTerrainTexture.h>

using namespace test;

namespace {

/// A value other than the default, as a file says it.
std::string otherValue(SoField* field) {
    if (field->isOfType(SoSFBool::getClassTypeId())) return static_cast<SoSFBool*>(field)->getValue() ? "FALSE" : "TRUE";
    if (field->isOfType(SoSFEnum::getClassTypeId())) {
        auto* choice = static_cast<SoSFEnum*>(field);
        for (int i = 0; i < choice->getNumEnums(); ++i) {
            SbName name;
            if (choice->getEnum(i, name) != choice->getValue()) return name.getString();
        }
    }
    if (field->isOfType(SoSFInt32::getClassTypeId())) return "63";
    if (field->isOfType(SoSFUInt32::getClassTypeId())) return "63";
    if (field->isOfType(SoSFFloat::getClassTypeId())) return "3.25";
    if (field->isOfType(SoSFVec2f::getClassTypeId())) return "2.5 7.25";
    if (field->isOfType(SoSFVec2d::getClassTypeId())) return "500000.125 5000000.0625";
    if (field->isOfType(SoSFVec2i32::getClassTypeId())) return "17 19";
    if (field->isOfType(SoSFString::getClassTypeId())) return "\"some where.png\"";
    if (field->isOfType(SoSFNode::getClassTypeId())) return "Cube { depth 5 }";
    return {};
}

/// An instance of every class of ours that a file may have.
std::vector<Ref<SoNode>> allNodes() {
    std::vector<Ref<SoNode>> all;
    SoTypeList types;
    SoType::getAllDerivedFrom(SoTerrainShape::getClassTypeId(), types);
    types.append(SoHeightMap::getClassTypeId());
    types.append(SoTerrainTexture::getClassTypeId());
    for (int i = 0; i < types.getLength(); ++i)
        if (types[i].canCreateInstance()) all.emplace_back(static_cast<SoNode*>(types[i].createInstance()));
    return all;
}

std::vector<std::pair<std::string, SoField*>> fieldsOf(SoNode* node) {
    SoFieldList fields;
    node->getFields(fields);
    std::vector<std::pair<std::string, SoField*>> all;
    for (int i = 0; i < fields.getLength(); ++i) {
        SbName name;
        node->getFieldName(fields[i], name);
        all.emplace_back(name.getString(), fields[i]);
    }
    return all;
}

std::string valueOf(SoField* field) {
    SbString text;
    field->get(text);
    return text.getString();
}

/// The same text by another name of the class, which nobody has a library for.
std::string renamed(std::string text, const std::string& name) {
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 9)) text.replace(at, name.size(), "SoNobodys");
    return text;
}

class ActionWrite : public OnEveryNode {};

}  // namespace

TEST(ActionFields, AreSetFromTextFromAFileAndInOneGo) {
    Messages messages;
    for (const auto& node : allNodes()) {
        const std::string name = node->getTypeId().getName().getString();
        Ref<SoNode> byText(static_cast<SoNode*>(node->getTypeId().createInstance()));
        std::string all;
        for (const auto& [field, data] : fieldsOf(node.get())) {
            const std::string other = otherValue(data);
            ASSERT_FALSE(other.empty()) << name << '.' << field << " is of a type that this test does not know";
            EXPECT_TRUE(node->getField(field.c_str())->set(other.c_str())) << name << '.' << field;
            EXPECT_FALSE(data->isDefault());
            all += field + ' ' + other + '\n';
        }
        EXPECT_TRUE(byText->set(all.c_str())) << name;
        const auto read = readBack("#Inventor V2.1 ascii\n" + name + " {\n" + all + "}\n");
        ASSERT_NE(read.get(), nullptr) << name;
        ASSERT_EQ(read->getNumChildren(), 1);
        for (const auto& [field, data] : fieldsOf(node.get())) {
            EXPECT_EQ(valueOf(byText->getField(field.c_str())), valueOf(data)) << name << '.' << field;
            EXPECT_EQ(valueOf(read->getChild(0)->getField(field.c_str())), valueOf(data)) << name << '.' << field;
        }
    }
    // SoHeightMap and SoTerrainTexture look for their files at once.
    for (const std::string& message : messages.all()) EXPECT_NE(message.find("some where.png"), std::string::npos) << message;
}

TEST(ActionFields, AreWrittenOnlyWhereTheyDiffer) {
    Messages messages;
    for (const auto& node : allNodes()) {
        const std::string name = node->getTypeId().getName().getString();
        for (const auto& [field, data] : fieldsOf(node.get())) {
            Ref<SoNode> fresh(static_cast<SoNode*>(node->getTypeId().createInstance()));
            EXPECT_TRUE(fresh->getField(field.c_str())->isDefault()) << name << '.' << field;
            fresh->getField(field.c_str())->set(otherValue(data).c_str());
            for (const bool binary : {false, true}) {
                const auto back = readBack(written(fresh.get(), binary));
                ASSERT_NE(back.get(), nullptr) << name << '.' << field;
                for (const auto& [each, value] : fieldsOf(back->getChild(0))) {
                    EXPECT_TRUE(binary || value->isDefault() == (each != field)) << name << '.' << each;
                    EXPECT_EQ(valueOf(value), valueOf(fresh->getField(each.c_str()))) << name << '.' << each;
                }
            }
        }
    }
}

TEST(ActionFields, AreKeptByProgramsWithoutTheLibrary) {
    Messages messages;
    for (const auto& node : allNodes()) {
        const std::string name = node->getTypeId().getName().getString();
        for (const auto& [field, data] : fieldsOf(node.get())) data->set(otherValue(data).c_str());
        const std::string text = renamed(written(node.get()), name);
        const auto unknown = readBack(text);
        ASSERT_NE(unknown.get(), nullptr) << text;
        SoNode* found = unknown->getNumChildren() == 1 ? unknown->getChild(0) : unknown.get();
        EXPECT_EQ(std::string(found->getTypeId().getName().getString()), "UnknownNode") << text;
        for (const auto& [field, data] : fieldsOf(node.get())) {
            ASSERT_NE(found->getField(field.c_str()), nullptr) << name << '.' << field;
            EXPECT_EQ(valueOf(found->getField(field.c_str())), valueOf(data)) << name << '.' << field;
        }
        EXPECT_TRUE(written(found) == text) << text << written(found);
        if (node->isOfType(SoTerrainShape::getClassTypeId())) {
            // The stand-in is what such a program shows.
            const SbBox3f box = boxOf(found);
            EXPECT_EQ(box.getMax()[2] - box.getMin()[2], 5.0f);
        }
    }
}

TEST_P(ActionWrite, AndReadGivesTheSameFieldsAndPicture) {
    Stage stage(160, 120);
    // Coin's rotations change by a last digit each time: the camera is not part of it.
    const auto scene = groundScene({});
    const auto shows = [&](SoNode* shape) {
        scene->replaceChild(2, shape);
        return stage.render(scene.get());
    };
    const auto root = groundShape(GetParam(), {.normals = false}, GetParam().overMap);
    terrainIn(root.get())->setName("ground");
    auto* again = new SoSeparator;
    again->addChild(terrainIn(root.get()));
    root->addChild(again);
    Messages messages;  // the second place has no data
    const auto before = shows(root.get());
    for (const bool binary : {false, true}) {
        const std::string text = written(root.get(), binary);
        const auto back = readBack(text);
        ASSERT_NE(back.get(), nullptr);
        EXPECT_TRUE(written(back.get(), binary) == text);
        EXPECT_TRUE(shows(back.get()).pixels == before.pixels);
        // Written once, used twice.
        const auto* second = static_cast<const SoSeparator*>(back->getChild(back->getNumChildren() - 1));
        ASSERT_EQ(second->getNumChildren(), 1);
        EXPECT_EQ(second->getChild(0), terrainIn(back.get()));
        EXPECT_TRUE(binary || text.find("USE ground") != std::string::npos);
    }
}

TEST(ActionHoles, OfCoordinatesAreLostInAFileAndThoseOfAHeightMapStay) {
    int errors = 0;
    SoErrorCB* const before = SoReadError::getHandlerCallback();
    SoReadError::setHandlerCallback([](const SoError*, void* count) { ++*static_cast<int*>(count); }, &errors);
    float height = 0.0f;
    for (const bool binary : {false, true})
        for (const bool overMap : {false, true}) {
            const auto root = groundShape(Where{Kind::BruteForce, overMap}, {.normals = false});
            ASSERT_FALSE(terrainIn(root.get())->heightAt(29.0f, 30.0f, height));
            const auto back = readBack(written(root.get(), binary));
            // Coin refuses the text "nan", and takes 0 for one in a binary file.
            ASSERT_EQ(back.get() == nullptr, !binary && !overMap);
            if (back.get()) {
                EXPECT_EQ(terrainIn(back.get())->heightAt(29.0f, 30.0f, height), !overMap);
            }
            EXPECT_EQ(errors > 0, !overMap);
            errors = 0;
        }
    SoReadError::setHandlerCallback(before, nullptr);
}

TEST(ActionFields, ThatAreDefaultSurviveABinaryFile) {
    Messages messages;
    for (const auto& node : allNodes()) {
        const auto back = readBack(written(node.get(), true));
        ASSERT_NE(back.get(), nullptr) << node->getTypeId().getName().getString();
        for (const auto& [field, value] : fieldsOf(back->getChild(0))) EXPECT_EQ(valueOf(value), valueOf(node->getField(field.c_str()))) << field;
    }
}

TEST_P(ActionWrite, KeepsConnections) {
    const auto root = groundShape(GetParam(), {}, GetParam().overMap);
    auto* engine = new SoCalculator;
    engine->a = 6.0f;
    engine->expression = "oa = a / 4";
    terrainIn(root.get())->pixelError.connectFrom(&engine->oa);
    const auto back = readBack(written(root.get()));
    ASSERT_NE(back.get(), nullptr);
    SoTerrainShape* node = terrainIn(back.get());
    ASSERT_NE(node, nullptr);
    SoEngineOutput* output = nullptr;
    ASSERT_TRUE(node->pixelError.getConnectedEngine(output));
    EXPECT_EQ(node->pixelError.getValue(), 1.5f);
    static_cast<SoCalculator*>(output->getContainer())->a = 10.0f;
    EXPECT_EQ(node->pixelError.getValue(), 2.5f);
}

INSTANTIATE_TEST_SUITE_P(, ActionWrite, testing::ValuesIn(everywhere()), nameOfWhere);
