#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "Harness.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include <Inventor/SoDB.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/misc/SoContextHandler.h>

#include <SoTerrain/SoTerrain.h>

#include "ImageFile.h"

using terrain::Image;

namespace test {

namespace {

Messages* listener = nullptr;

class CoinEnvironment : public testing::Environment {
public:
    void SetUp() override;
};

const testing::Environment* const environment = testing::AddGlobalTestEnvironment(new CoinEnvironment);

bool isCovered(const Image& image, int x, int y) {
    const std::uint8_t* p = image.pixels.data() + (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 3;
    return p[0] != kBackground[0] || p[1] != kBackground[1] || p[2] != kBackground[2];
}

bool isCoveredAround(const Image& image, int x, int y, int rim) {
    for (int v = std::max(0, y - rim); v <= std::min(image.height - 1, y + rim); ++v)
        for (int u = std::max(0, x - rim); u <= std::min(image.width - 1, x + rim); ++u)
            if (!isCovered(image, u, v)) return false;
    return true;
}

}  // namespace

struct MessageHandler {
    static void handle(const SoError* error, void*) {
        const std::string text = error->getDebugString().getString();
        // Coin asks GLX for what an EGL context can't tell it.
        if (text.find("glxglue") != std::string::npos) return;
        if (listener)
            listener->all_.push_back(text);
        else
            ADD_FAILURE() << "unexpected message: " << text;
    }
};

namespace {

void CoinEnvironment::SetUp() {
    // With buffers Coin's own shapes take the texture coordinates of the last unit for the first.
    setenv("COIN_VBO", "0", 1);
    SoDB::init();
    SoInteraction::init();
    SoTerrain::init();
    SoDebugError::setHandlerCallback(MessageHandler::handle, nullptr);
}

}  // namespace

Messages::Messages() : outer_(listener) { listener = this; }

Messages::~Messages() { listener = outer_; }

std::string Messages::text() const {
    std::string all;
    for (const std::string& message : all_) all += message + '\n';
    return all;
}

Stage::Stage(int width, int height) {
    auto made = terrain::HeadlessContext::create(width, height);
    if (!made) {
        ADD_FAILURE() << made.error().message();
        std::exit(EXIT_FAILURE);
    }
    context_ = std::move(made).value();
    action_ = std::make_unique<SoGLRenderAction>(region());
    cacheContext_ = SoGLCacheContextElement::getUniqueCacheContext();
    action_->setCacheContext(cacheContext_);
}

Stage::~Stage() {
    makeCurrent();
    SoContextHandler::destructingContext(cacheContext_);
    action_.reset();
}

void Stage::makeCurrent() {
    context_->makeCurrent();
    context_->bindFramebuffer();
}

void Stage::clear() {
    makeCurrent();
    glDisable(GL_SCISSOR_TEST);
    glClearColor(kBackground[0] / 255.0f, kBackground[1] / 255.0f, kBackground[2] / 255.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void Stage::draw(SoNode* root, const SbViewportRegion* region) {
    makeCurrent();
    glEnable(GL_DEPTH_TEST);
    action_->setViewportRegion(region ? *region : this->region());
    action_->apply(root);
    for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError())
        ADD_FAILURE() << "GL error 0x" << std::hex << error;
}

Image Stage::render(SoNode* root) {
    clear();
    draw(root);
    return picture();
}

Difference compare(const Image& first, const Image& second, int rim) {
    Difference result;
    if (first.width != second.width || first.height != second.height) {
        ADD_FAILURE() << "pictures of different sizes";
        return result;
    }
    double sum = 0.0;
    for (int y = 0; y < first.height; ++y)
        for (int x = 0; x < first.width; ++x) {
            const bool a = isCovered(first, x, y), b = isCovered(second, x, y);
            if (a && !b && isCoveredAround(first, x, y, rim)) ++result.onlyFirst;
            if (b && !a && isCoveredAround(second, x, y, rim)) ++result.onlySecond;
            if (!a || !b) continue;
            ++result.covered;
            for (int c = 0; c < 3; ++c) {
                const std::size_t at = (std::size_t(y) * std::size_t(first.width) + std::size_t(x)) * 3 + std::size_t(c);
                const int difference = std::abs(int(first.pixels[at]) - int(second.pixels[at]));
                sum += difference;
                result.largest = std::max(result.largest, difference);
            }
        }
    if (result.covered > 0) result.mean = sum / (3.0 * result.covered);
    return result;
}

void expectAlike(const Image& first, const Image& second, double mean, const std::string& what, int rim) {
    const Difference found = compare(first, second, rim);
    EXPECT_EQ(found.onlyFirst, 0) << what << ": pixels that only the first picture covers";
    EXPECT_EQ(found.onlySecond, 0) << what << ": pixels that only the second picture covers";
    EXPECT_GT(found.covered, 100) << what << ": nothing to compare";
    EXPECT_LE(found.mean, mean) << what << ", largest difference " << found.largest;
}

int coveredPixels(const Image& image) {
    int count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) count += isCovered(image, x, y) ? 1 : 0;
    return count;
}

std::vector<double> meanColor(const Image& image) {
    std::vector<double> sum(3, 0.0);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (isCovered(image, x, y))
                for (int c = 0; c < 3; ++c)
                    sum[std::size_t(c)] += image.pixels[(std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 3 + std::size_t(c)];
    for (double& channel : sum) channel /= std::max(1, coveredPixels(image));
    return sum;
}

void savePicture(const std::string& name, const std::vector<Image>& images) {
    Image sheet;
    for (const Image& image : images) {
        sheet.width += image.width;
        sheet.height = std::max(sheet.height, image.height);
    }
    sheet.pixels.resize(std::size_t(sheet.width) * std::size_t(sheet.height) * 3);
    std::size_t left = 0;
    for (const Image& image : images) {
        for (int y = 0; y < image.height; ++y)
            std::copy_n(image.pixels.begin() + std::ptrdiff_t(y) * image.width * 3, image.width * 3,
                        sheet.pixels.begin() + std::ptrdiff_t((std::size_t(y) * std::size_t(sheet.width) + left) * 3));
        left += std::size_t(image.width);
    }
    const char* build = std::getenv("SOTERRAIN_BUILDDIR");
    const std::string folder = std::string(build ? build : ".") + "/tests/pictures";
    std::filesystem::create_directories(folder);
#ifdef HAVE_OPENIMAGEIO
    const std::string path = folder + '/' + name + ".png";
#else
    const std::string path = folder + '/' + name + ".ppm";
#endif
    if (const auto error = app::writeImage(path, sheet)) ADD_FAILURE() << error->message();
}

TemporaryFolder::TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "soterrain-XXXXXX").string();
    if (!mkdtemp(name.data())) ADD_FAILURE() << "no temporary folder";
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace test
