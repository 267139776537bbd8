// Nodes in binary files: come back with the same fields, which are described there.
#include "Actions.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <Inventor/errors/SoReadError.h>
#include <Inventor/nodes/SoCube.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoSphere.h>

#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoPerfGraph.h>
#include <SoTerrain/SoTerrainDrape.h>
#include <SoTerrain/SoTerrainKit.h>
#include <SoTerrain/SoTerrainPlacement.h>

using namespace test;

namespace {

/// Collects what Coin says of what it can't read.
class ReadErrors {
public:
    ReadErrors() : before_(SoReadError::getHandlerCallback()) {
        SoReadError::setHandlerCallback(
            [](const SoError* error, void* text) { *static_cast<std::string*>(text) += error->getDebugString().getString(); },
            &text_);
    }
    ~ReadErrors() { SoReadError::setHandlerCallback(before_, nullptr); }
    const std::string& text() const { return text_; }

private:
    std::string text_;
    SoErrorCB* before_;
};

SoNode* cube() {
    auto* node = new SoCube;
    node->depth = 5.0f;
    return node;
}

/// The node with other values than the defaults in some of its fields, before another node that must stay, too.
Ref<SoSeparator> sceneWith(SoNode* node, const char* fields) {
    Ref<SoSeparator> root(new SoSeparator);
    EXPECT_TRUE(node->set(fields));
    root->addChild(node);
    root->addChild(new SoSphere);
    return root;
}

std::vector<Ref<SoSeparator>> scenes() {
    auto* drape = new SoTerrainDrape;
    drape->alternateRep = cube();
    auto* kit = new SoTerrainKit;
    kit->alternateRep = cube();
    static_cast<SoMaterial*>(kit->getPart("material", TRUE))->shininess = 0.75f;
    auto* placement = new SoTerrainPlacement;
    return {sceneWith(new SoPerfGraph, "counter [ \"fps\", \"\" ] position -8 4.5 on FALSE"),
            sceneWith(placement, "point 3 4 align TRUE verticesPerRow 9"),
            sceneWith(drape, "point [ 1 2, 3 4.5 ] numVertices [ 1, 1 ] offset 2.5 closed TRUE"),
            sceneWith(kit, "algorithm GEO_MIPMAP heightMap SoHeightMap { heightScale 3 }")};
}

}  // namespace

TEST(BinaryFiles, DescribeTheFieldsThatAreInUseAndNoOthers) {
    // Programs without the library know the types of fields from nothing else.
    for (const auto& scene : scenes()) {
        SoNode* node = scene->getChild(0);
        const std::string name = node->getTypeId().getName().getString(), file = written(scene.get(), true);
        SoFieldList fields;
        node->getFields(fields);
        for (int i = 0; i < fields.getLength(); ++i) {
            SbName field;
            node->getFieldName(fields[i], field);
            const std::string type = fields[i]->getTypeId().getName().getString();
            // Texts are padded with zeros to whole words, after a word that says how long they are.
            const auto padded = [](std::string text) { return text + std::string((4 - text.size() % 4) % 4, '\0'); };
            const auto length = [](std::size_t size) { return std::string({'\0', '\0', '\0', char(size)}); };
            const std::string what = padded(type) + length(field.getLength()) + padded(field.getString());
            EXPECT_EQ(file.find(what) != std::string::npos, fields[i]->shouldWrite()) << name << '.' << field.getString();
        }
    }
}

TEST(BinaryFiles, GiveBackWhatWasWritten) {
    for (const auto& scene : scenes()) {
        SoNode* node = scene->getChild(0);
        const std::string name = node->getTypeId().getName().getString();
        const std::string text = written(scene.get());
        const ReadErrors errors;
        const auto back = readBack(written(scene.get(), true));
        ASSERT_NE(back.get(), nullptr) << name << errors.text();
        EXPECT_EQ(errors.text(), "") << name;
        ASSERT_EQ(back->getNumChildren(), 2) << name;
        EXPECT_EQ(written(back.get()), text);
        // A binary file between leaves nothing behind.
        EXPECT_EQ(written(scene.get()), text);
        // Those of nothing but defaults, too.
        Ref<SoSeparator> plain(new SoSeparator);
        plain->addChild(static_cast<SoNode*>(node->getTypeId().createInstance()));
        const auto again = readBack(written(plain.get(), true));
        ASSERT_NE(again.get(), nullptr) << name;
        EXPECT_EQ(errors.text(), "") << name;
        ASSERT_EQ(again->getNumChildren(), 1) << name;
        EXPECT_EQ(written(again.get()), written(plain.get()));
    }
}

TEST(BinaryFiles, WriteANodeOnceThatIsUsedTwice) {
    for (const auto& scene : scenes()) {
        scene->addChild(scene->getChild(0));
        const auto back = readBack(written(scene.get(), true));
        ASSERT_NE(back.get(), nullptr);
        ASSERT_EQ(back->getNumChildren(), 3);
        EXPECT_EQ(back->getChild(0), back->getChild(2));
    }
}
