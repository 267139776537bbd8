#include "BenchScene.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/fields/SoSFBool.h>
#include <Inventor/fields/SoSFFloat.h>
#include <Inventor/fields/SoSFInt32.h>
#include <Inventor/nodes/SoBaseColor.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoDrawStyle.h>
#include <Inventor/nodes/SoIndexedFaceSet.h>
#include <Inventor/nodes/SoIndexedTriangleStripSet.h>
#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoNormal.h>
#include <Inventor/nodes/SoNormalBinding.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>
#include <Inventor/nodes/SoPolygonOffset.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoTexture2.h>
#include <Inventor/nodes/SoTextureCoordinate2.h>
#include <Inventor/sensors/SoSensorManager.h>

#include "Clock.h"
#include "Texture.h"

namespace app {

using terrain::Error;
using terrain::HeadlessContext;
using terrain::Result;

namespace {

constexpr int width = 1024;
constexpr int height = 768;

void turnRows(terrain::HeightMap& map) {
    for (int row = 0; row < map.rows / 2; ++row) {
        const auto first = map.heights.begin() + std::ptrdiff_t(row) * map.columns;
        std::swap_ranges(first, first + map.columns, map.heights.end() - std::ptrdiff_t(row + 1) * map.columns);
    }
}

// Each of so many columns and rows, over the same ground.
terrain::HeightMap decimated(const terrain::HeightMap& map, int step) {
    terrain::HeightMap result = map;
    result.columns = (map.columns - 1) / step + 1;
    result.rows = (map.rows - 1) / step + 1;
    result.spacing = map.spacing * double(step);
    std::vector<float> heights;
    heights.reserve(std::size_t(result.columns) * std::size_t(result.rows));
    for (int row = 0; row < result.rows; ++row)
        for (int column = 0; column < result.columns; ++column) heights.push_back(map.at(column * step, row * step));
    result.heights = terrain::HeightStorage(std::move(heights));
    return result;
}

// Whether the map is laid over the unit square as the file has it, because neither it nor the request says more.
bool isTopFirst(const BenchRequest& request, const terrain::HeightMap& map) {
    return request.flight.empty() && !request.spacing && !request.heightScale && map.projection.empty() &&
           map.spacing == glm::dvec2(1.0, 1.0);
}

// Whether a node reads these fields and nothing is left: SoFieldContainer::set() stops at a name that is none without a word.
bool areFields(const std::string& className, const std::string& fields) {
    const std::string text = "#Inventor V2.1 ascii\n" + className + " {\n" + fields + "\n}\n";
    SoInput input;
    input.setBuffer(text.data(), text.size());
    SoNode* read = nullptr;
    const bool valid = SoDB::read(&input, read) && read;
    if (read) {
        read->ref();
        read->unref();
    }
    return valid;
}

}  // namespace

FlightArea flightAreaOf(const TerrainGrid& grid) {
    FlightArea area;
    area.width = float(grid.columns * grid.spacing.x);
    area.depth = float(grid.rows * grid.spacing.y);
    const bool standard = area.width == 1.0f && area.depth == 1.0f && grid.minimum >= 0.0 && grid.maximum <= 1.001 * standardHeight;
    const double size = std::max((grid.columns - 1) * grid.spacing.x, (grid.rows - 1) * grid.spacing.y);
    if (!standard) area.altitude = float(grid.maximum + (area.altitude - standardHeight) * size);
    return area;
}

Result<BenchMap> openBenchMap(const BenchRequest& request) {
    auto source = terrain::openHeightFile(request.map, {});
    if (!source) return source.error();
    const terrain::HeightMap* resident = source.value()->map();
    if (!resident) return Error{request.map, "a map that fits into memory", "a larger one"};
    const int step = std::max(1, request.decimate);
    if ((std::min(resident->columns, resident->rows) - 1) / step < 1)
        return Error{request.map, "at least 2 x 2 samples of every " + std::to_string(step), "fewer"};
    if (double(resident->columns) * resident->rows > maxCoinSamples)
        return Error{request.map, "at most 250 million samples", "more"};
    const bool hasSpacing = !resident->projection.empty() || resident->spacing != glm::dvec2(1.0, 1.0);
    const bool topFirst = isTopFirst(request, *resident);
    terrain::HeightMap map = step > 1 ? decimated(*resident, step) : *resident;
    if (!hasSpacing) map.spacing = {1.0, 1.0};
    if (topFirst) turnRows(map);
    auto taken = terrain::makeMapSource(std::move(map));
    if (!taken) return taken.error();
    const auto spacing = request.spacing ? std::optional(*request.spacing * double(step)) : std::nullopt;
    auto grid = placeGrid(std::move(taken).value(), spacing, request.heightScale);
    if (!grid) return grid.error();
    return BenchMap{std::move(grid).value(), topFirst};
}

BenchScene::BenchScene(const BenchRequest& request)
    : request_(request), action_(SbViewportRegion(width, height)), flight_(standardFlight({}, 1.0)) {}

std::optional<Error> BenchScene::prepare() {
    auto map = openBenchMap(request_);
    if (!map) return map.error();
    grid_ = std::move(map.value().grid);
    topFirst_ = map.value().topFirst;
    if (auto problem = openFlight()) return problem;
    auto context = HeadlessContext::create(width, height);
    if (!context) return context.error();
    context_ = std::move(context).value();
    action_.setCacheContext(SoGLCacheContextElement::getUniqueCacheContext());
    glEnable(GL_DEPTH_TEST);
    glClearColor(0.45f, 0.6f, 0.85f, 1.0f);
    if (auto problem = addData()) return problem;
    return makeNode();
}

std::optional<Error> BenchScene::openFlight() {
    flight_ = standardFlight(flightAreaOf(grid_), 1.0);
    if (request_.flight.empty()) return std::nullopt;
    const auto flight = readFlightFile(request_.flight);
    if (!flight) return flight.error();
    flight_ = flight.value().lasting(1.0);
    return std::nullopt;
}

void BenchScene::addCamera() {
    camera_ = new SoPerspectiveCamera;
    camera_->heightAngle = std::numbers::pi_v<float> / 4.0f;
    camera_->aspectRatio = float(width) / float(height);
    // As far as SoTerrainTest looks.
    const double reach = std::max({grid_.columns * grid_.spacing.x, grid_.rows * grid_.spacing.y, grid_.maximum - grid_.minimum});
    camera_->nearDistance = float(0.001 * reach);
    camera_->farDistance = float(3.0 * reach);
    auto* light = new SoDirectionalLight;
    light->direction.setValue(0.5f, 0.5f, -1.0f);
    group_->addChild(camera_);
    group_->addChild(light);
}

// As SoTerrainTest has it: white under a texture, the colour of earth without one.
void BenchScene::addMaterial() {
    auto* material = new SoMaterial;
    const SbColor color = request_.texture.empty() ? SbColor(0.62f, 0.57f, 0.47f) : SbColor(1.0f, 1.0f, 1.0f);
    material->diffuseColor = color;
    material->ambientColor = color * 0.4f;
    group_->addChild(material);
}

std::optional<Error> BenchScene::addData() {
    root_ = NodePtr(new SoSeparator);
    root_->renderCaching = SoSeparator::OFF;
    root_->addChild(group_ = new SoSeparator);
    addCamera();
    group_->addChild(style_ = new SoDrawStyle);
    addMaterial();
    if (!request_.texture.empty()) {
        auto texture = loadTexture(request_.texture, topFirst_);
        if (!texture) return texture.error();
        group_->addChild(texture.value());
    }
    SoCoordinate3* coordinates = makeCoordinates(grid_);
    binding_ = new SoNormalBinding;
    binding_->value = SoNormalBinding::PER_VERTEX_INDEXED;
    group_->addChild(makeTextureCoordinates(grid_.columns, grid_.rows, {1.0 / grid_.columns, 1.0 / grid_.rows}));
    group_->addChild(coordinates);
    group_->addChild(makeNormals(*coordinates, grid_.columns, grid_.rows));
    group_->addChild(binding_);
    return std::nullopt;
}

std::optional<Error> BenchScene::makeNode() {
    const std::string& name = request_.className;
    if (name == "SoIndexedFaceSet") {
        node_ = NodePtr<SoNode>(makeFaceSet(grid_));
    } else {
        const SoType type = SoType::fromName(name.c_str());
        if (!type.isDerivedFrom(SoNode::getClassTypeId()) || !type.canCreateInstance()) {
            return Error{name, "a node class of Coin or this build", "none of this name"};
        }
        node_ = NodePtr(static_cast<SoNode*>(type.createInstance()));
    }
    if (name == "SoQuadMesh") binding_->value = SoNormalBinding::PER_VERTEX;
    const auto set = [this](const char* field, int value) {
        if (auto* number = dynamic_cast<SoSFInt32*>(node_->getField(field))) number->setValue(value);
    };
    set("verticesPerRow", grid_.columns);
    set("verticesPerColumn", grid_.rows);
    if (auto* error = dynamic_cast<SoSFFloat*>(node_->getField("pixelError"))) error->setValue(float(request_.pixelError));
    if (!request_.fields.empty() && !(areFields(name, request_.fields) && node_->set(request_.fields.c_str())))
        return Error{name, "fields of this class", '"' + request_.fields + '"'};
    return std::nullopt;
}

void BenchScene::warmUp() {
    auto* triangles = new SoIndexedTriangleStripSet;
    const int32_t corners[] = {0, grid_.columns - 1, grid_.columns * (grid_.rows - 1), SO_END_STRIP_INDEX};
    triangles->coordIndex.setValues(0, 4, corners);
    group_->addChild(triangles);
    frame(0);
    frame(0);
    group_->removeChild(triangles);
    group_->addChild(node_.get());
}

double BenchScene::frame(int i) {
    // The standard flight is a circle; another ends where it ends.
    const int last = request_.flight.empty() ? request_.frames : std::max(1, request_.frames - 1);
    const Pose pose = flight_.at(double(i) / last);
    const double start = nowMs();
    camera_->position = pose.position;
    camera_->orientation = pose.orientation;
    SoDB::getSensorManager()->processDelayQueue(TRUE);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    action_.apply(root_.get());
    glFinish();
    return nowMs() - start;
}

void BenchScene::setBackground(bool on) {
    if (auto* background = dynamic_cast<SoSFBool*>(node_->getField("background"))) background->setValue(on);
}

void BenchScene::wireframe(int i) {
    const SbColor paper(0.97f, 0.97f, 0.97f), lines(0.1f, 0.15f, 0.2f);
    if (!ink_) {
        glClearColor(paper[0], paper[1], paper[2], 1.0f);
        auto* light = new SoLightModel;
        light->model = SoLightModel::BASE_COLOR;
        const int last = group_->getNumChildren() - 1;
        group_->insertChild(ink_ = new SoBaseColor, last);
        group_->insertChild(light, last);
        group_->insertChild(new SoTexture2, last);
        group_->insertChild(new SoPolygonOffset, last);
    }
    ink_->rgb = paper;
    style_->style = SoDrawStyle::FILLED;
    frame(i);
    ink_->rgb = lines;
    style_->style = SoDrawStyle::LINES;
    action_.apply(root_.get());
    glFinish();
}

}  // namespace app
