// Scenes with the terrain nodes, as text: read, drawn, asked, written, copied, changed and drawn again. SceneGrammar makes them.
#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <vector>

#include <Inventor/SoDB.h>
#include <Inventor/SoFullPath.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/SoOutput.h>
#include <Inventor/SoPath.h>
#include <Inventor/SoPickedPoint.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/actions/SoWriteAction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/fields/SoSFFloat.h>
#include <Inventor/fields/SoSFVec2f.h>
#include <Inventor/fields/SoSFVec3f.h>
#include <Inventor/misc/SoContextHandler.h>
#include <Inventor/nodekits/SoNodeKit.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoOrthographicCamera.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoTranslation.h>

#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoTerrain.h>
#include <SoTerrain/SoTerrainShape.h>

#include "Input.h"
#include "SceneGrammar.h"
#include "gl/HeadlessContext.h"

namespace {

constexpr short kWidth = 64, kHeight = 48;

/// What lives as long as the process.
struct Stage {
    std::unique_ptr<terrain::HeadlessContext> context;
    std::unique_ptr<SoGLRenderAction> action;
    std::unique_ptr<fuzz::SceneGrammar> grammar;
    std::string folder;
    int runs = 0;

    ~Stage() {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
} stage;

struct Unref {
    void operator()(SoBase* base) const { base->unref(); }
};
template <class T>
using Held = std::unique_ptr<T, Unref>;

template <class T>
Held<T> held(T* base) {
    base->ref();
    return Held<T>(base);
}

void ignore(const SoError*, void*) {}

void* grow(void* buffer, std::size_t size) {
    return std::realloc(buffer, size);
}

/// All nodes of the scene of a class, in whatever part of it.
std::vector<SoNode*> nodesOf(SoNode* root, const std::string& name) {
    SoSearchAction search;
    search.setType(SoType::fromName(SbName(name.c_str())));
    search.setInterest(SoSearchAction::ALL);
    search.setSearchingAll(TRUE);
    search.apply(root);
    std::vector<SoNode*> nodes;
    for (int i = 0; i < search.getPaths().getLength(); ++i)
        nodes.push_back(static_cast<SoFullPath*>(search.getPaths()[i])->getTail());
    return nodes;
}

SoField* fieldOf(SoNode* root, const std::string& name) {
    const std::size_t dot = name.find('.');
    if (dot == std::string::npos || SoType::fromName(SbName(name.substr(0, dot).c_str())).isBad()) return nullptr;
    const auto nodes = nodesOf(root, name.substr(0, dot));
    return nodes.empty() ? nullptr : nodes.front()->getField(SbName(name.substr(dot + 1).c_str()));
}

void setNaN(SoField* field) {
    const float none = std::nanf("");
    if (auto* number = dynamic_cast<SoSFFloat*>(field)) number->setValue(none);
    if (auto* two = dynamic_cast<SoSFVec2f*>(field)) two->setValue(none, 1.0f);
    if (auto* three = dynamic_cast<SoSFVec3f*>(field)) three->setValue(1.0f, none, none);
}

/// A camera that looks at the terrain, or anything.
Held<SoCamera> cameraOf(std::mt19937& random) {
    const auto share = [&random] { return float(random() % 10001) / 10000.0f; };
    const auto wild = [&random] { return float(fuzz::kNumbers[random() % fuzz::kFinite]); };
    Held<SoCamera> camera = random() % 4 ? held<SoCamera>(new SoPerspectiveCamera) : held<SoCamera>(new SoOrthographicCamera);
    const float size = random() % 3 ? 12.0f : 200.0f;
    camera->position.setValue(size * (share() - 0.3f), size * (share() - 0.3f), size * share());
    camera->pointAt(SbVec3f(size * share() * 0.5f, size * share() * 0.5f, 0.0f), SbVec3f(0.0f, 0.0f, 1.0f));
    camera->nearDistance = 0.05f;
    camera->farDistance = 500.0f;
    if (auto* flat = dynamic_cast<SoOrthographicCamera*>(camera.get())) flat->height = 0.1f + 30.0f * share();
    if (random() % 5) return camera;
    switch (random() % 5) {
    case 0:
        camera->position.setValue(wild(), wild(), wild());
        break;
    case 1:
        camera->nearDistance = wild();
        break;
    case 2:
        camera->farDistance = wild();
        break;
    case 3:
        camera->orientation.setValue(SbVec3f(share(), share(), share()), wild());
        break;
    default:
        camera->aspectRatio = wild();
        break;
    }
    return camera;
}

void draw(SoNode* scene, SoCamera* camera) {
    const Held<SoSeparator> root = held(new SoSeparator);
    root->addChild(camera);
    root->addChild(new SoDirectionalLight);
    root->addChild(scene);
    stage.context->bindFramebuffer();
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    stage.action->apply(root.get());
    root->removeAllChildren();
    while (glGetError() != GL_NO_ERROR) {
    }
}

/// Triangles that are looked at one by one, for a run to end in time.
constexpr long kMostTriangles = 200000;

void countVertices(void* counter, SoCallbackAction*, const SoPrimitiveVertex* a, const SoPrimitiveVertex*,
                   const SoPrimitiveVertex*) {
    *static_cast<double*>(counter) += double(a->getPoint()[2]);
}

SoCallbackAction::Response atShape(void*, SoCallbackAction* action, const SoNode* node) {
    // What nothing but the action knows: that the state is whole in the middle of the scene.
    fuzz::check(action->getState() && node, "a node without a state");
    return SoCallbackAction::CONTINUE;
}

void pick(SoNode* root, std::mt19937& random) {
    SoRayPickAction action(SbViewportRegion(kWidth, kHeight));
    const auto number = [&random] {
        return random() % 3 ? float(random() % 200) / 10.0f : float(fuzz::kNumbers[random() % fuzz::kNumbers.size()]);
    };
    action.setPickAll(random() % 2);
    action.setRadius(float(random() % 10));
    action.setRay(SbVec3f(number(), number(), number()), SbVec3f(number() - 5.0f, number() - 5.0f, -number() - 0.1f));
    action.apply(root);
    const SoPickedPointList& points = action.getPickedPointList();
    for (int i = 0; i < points.getLength(); ++i) points[i]->getDetail();
}

/// Everything that Coin asks of a scene besides its picture.
void ask(SoNode* root, std::mt19937& random) {
    const SbViewportRegion region(kWidth, kHeight);
    SoGetBoundingBoxAction box(region);
    box.apply(root);
    pick(root, random);
    SoGetPrimitiveCountAction count(region);
    count.apply(root);
    if (count.getTriangleCount() < kMostTriangles) {
        double sum = 0.0;
        SoCallbackAction callback(region);
        callback.addTriangleCallback(SoTerrainShape::getClassTypeId(), countVertices, &sum);
        callback.addPreCallback(SoTerrainShape::getClassTypeId(), atShape, nullptr);
        callback.apply(root);
    }
    for (SoNode* node : nodesOf(root, "SoTerrainShape")) {
        auto* shape = static_cast<SoTerrainShape*>(node);
        float height = 0.0f;
        SbVec3f normal;
        shape->heightAt(float(random() % 9), float(random() % 9) + 0.5f, height, &normal);
        const SoTerrainStatistics statistics = shape->getStatistics();
        fuzz::check(!(statistics.errorPixels < 0.0) && !std::isnan(statistics.errorPixels), "an error that is no number");
    }
}

std::string written(SoNode* root) {
    SoOutput output;
    output.setBuffer(std::malloc(1024), 1024, grow);
    SoWriteAction(&output).apply(root);
    void* buffer = nullptr;
    std::size_t size = 0;
    output.getBuffer(buffer, size);
    std::string text(static_cast<const char*>(buffer), size);
    std::free(buffer);
    return text;
}

Held<SoSeparator> read(const std::string& text) {
    SoInput input;
    input.setBuffer(text.data(), text.size());
    SoSeparator* root = SoDB::readAll(&input);
    return root ? held(root) : nullptr;
}

/// Other heights for a rectangle, or a map of such a size, whatever the numbers say: only those that fit have as many floats.
void changeHeights(SoHeightMap* map, std::istringstream& words) {
    constexpr long kMost = 1600;
    int column = 0, row = 0, columns = 0, rows = 0, mapColumns = 0, mapRows = 0;
    unsigned seed = 0;
    if (!(words >> column >> row >> columns >> rows >> seed)) return;
    const bool isSmall = columns > 0 && rows > 0 && long(columns) * long(rows) <= kMost;
    std::vector<float> heights(isSmall ? std::size_t(columns) * std::size_t(rows) : 1);
    std::mt19937 random(seed);
    for (float& height : heights)
        height = random() % 8 ? float(random() % 100) / 20.0f : float(fuzz::kNumbers[random() % fuzz::kNumbers.size()]);
    if (seed % 4 == 0 && (isSmall || columns < 2 || rows < 2)) map->setHeights(columns, rows, heights.data());
    map->getSize(mapColumns, mapRows);
    const bool fits =
        column >= 0 && row >= 0 && columns > 0 && rows > 0 && long(column) + columns <= mapColumns && long(row) + rows <= mapRows;
    if (fits && !isSmall) return;
    fuzz::check(map->setHeights(column, row, columns, rows, heights.data()) == fits, "a rectangle in the map, or not");
    fuzz::check(map->getHeights(column, row, columns, rows, heights.data()) == fits, "heights of what is not there");
}

/// One of the lines that begin with #.
void perform(const std::string& line, SoSeparator* root) {
    std::istringstream words(line);
    std::string verb, name, other;
    words >> verb >> name;
    if (verb == "#again") {
        auto* moved = new SoTranslation;
        moved->translation.setValue(3.0f, 1.0f, 0.5f);
        root->addChild(moved);
        for (int i = 0, count = root->getNumChildren(); i < count && i < 8; ++i) root->addChild(root->getChild(i));
        return;
    }
    if (verb == "#heights") {
        std::istringstream numbers(line.substr(verb.size()));
        const auto maps = nodesOf(root, "SoHeightMap");
        if (!maps.empty()) changeHeights(static_cast<SoHeightMap*>(maps.back()), numbers);
        return;
    }
    SoField* field = fieldOf(root, name);
    if (!field) return;
    if (verb == "#set") {
        std::getline(words, other);
        if (other == " NaN")
            setNaN(field);
        else
            field->set(other.c_str());
    } else if (verb == "#connect" && words >> other) {
        SoField* from = fieldOf(root, other);
        if (from && from != field && from->getTypeId() == field->getTypeId() && !from->isConnected()) field->connectFrom(from);
    }
}

void run(const std::string& text) {
    const Held<SoSeparator> root = read(text);
    if (!root) return;
    std::vector<std::string> notes;
    std::mt19937 random(1);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line) && (line.empty() || line[0] == '#');) {
        if (line.starts_with("#view ")) random.seed(unsigned(std::strtoul(line.c_str() + 6, nullptr, 10)));
        notes.push_back(line);
    }
    const Held<SoCamera> camera = cameraOf(random);
    draw(root.get(), camera.get());
    ask(root.get(), random);
    for (const std::string& line : notes) perform(line, root.get());
    draw(root.get(), camera.get());
    draw(root.get(), cameraOf(random).get());
    if (!notes.empty()) ask(root.get(), random);
    if (const Held<SoSeparator> again = read(written(root.get())); again && random() % 2) draw(again.get(), camera.get());
    const Held<SoNode> copy = held(root->copy(TRUE));
    draw(copy.get(), camera.get());
}

void writeFile(const std::string& name, const std::string& bytes) {
    std::ofstream(stage.folder + '/' + name, std::ios::binary) << bytes;
}

/// The files that scenes may name.
std::vector<std::string> makeFiles() {
    std::string hills, tall, colours = "P3\n16 16\n255\n",
                             table = "ncols 6\nnrows 5\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -1\n";
    for (int i = 0; i < 289; ++i) hills += char(int(120 + 120 * std::sin(0.2 * (i % 17)) * std::cos(0.3 * (i / 17))) & 255);
    for (int i = 0; i < 5 * 40 * 2; ++i) tall += char(i * 37);
    for (int i = 0; i < 16 * 16 * 3; ++i) colours += std::to_string(i % 256) + ' ';
    for (int i = 0; i < 30; ++i) table += std::to_string(i % 7 == 3 ? -1 : i) + ' ';
    writeFile("hills.raw", hills);
    writeFile("tall.raw", tall);
    writeFile("colours.ppm", colours);
    writeFile("grey.pgm", "P2\n4 3\n255\n1 2 3 4 5 6 7 8 9 10 11 255\n");
    writeFile("holes.asc", table);
    writeFile("short.pgm", "P5\n40 40\n255\nabc");
    writeFile("empty.raw", "");
    writeFile("scene.iv", "#Inventor V2.1 ascii\nCube { }\n");
    return {"hills.raw", "tall.raw", "colours.ppm", "grey.pgm", "holes.asc", "short.pgm",
            "empty.raw", "scene.iv", "missing.png", ".",        ""};
}

void newCacheContext() {
    stage.action->setCacheContext(SoGLCacheContextElement::getUniqueCacheContext());
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
    std::mt19937 random(seed);
    const std::string before(reinterpret_cast<const char*>(data), size);
    for (int tries = 0; tries < 5; ++tries) {
        const std::string after = stage.grammar->changed(before, random);
        if (after.size() > most) continue;
        std::memcpy(data, after.data(), after.size());
        return after.size();
    }
    return size;
}

int LLVMFuzzerInitialize(int*, char***) {
    setenv("COIN_VBO", "0", 1);
    SoDB::init();
    SoNodeKit::init();
    SoInteraction::init();
    SoTerrain::init();
    SoDebugError::setHandlerCallback(ignore, nullptr);
    SoReadError::setHandlerCallback(ignore, nullptr);
    std::string name = (std::filesystem::temp_directory_path() / "soterrain-fuzz-XXXXXX").string();
    fuzz::check(mkdtemp(name.data()), "no temporary folder");
    stage.folder = name;
    stage.grammar = std::make_unique<fuzz::SceneGrammar>(makeFiles());
    SoInput::addDirectoryFirst(stage.folder.c_str());
    auto context = terrain::HeadlessContext::create(kWidth, kHeight);
    if (!context) fuzz::fail(context.error().message());
    stage.context = std::move(context).value();
    stage.action = std::make_unique<SoGLRenderAction>(SbViewportRegion(kWidth, kHeight));
    newCacheContext();
    std::mt19937 random(11);
    for (int seed = 0; seed < 60; ++seed) fuzz::writeSeed("scene" + std::to_string(seed), stage.grammar->scene(random));
    return 0;
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    run(std::string(reinterpret_cast<const char*>(data), size));
    // What a node leaves in a context goes with it, or in the next frame there: both are tried.
    constexpr int kRunsOfAContext = 50;
    if (++stage.runs % kRunsOfAContext == 0) {
        SoContextHandler::destructingContext(std::uint32_t(stage.action->getCacheContext()));
        newCacheContext();
    }
    return 0;
}
