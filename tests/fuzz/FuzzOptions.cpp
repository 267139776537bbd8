// Command lines of SoTerrainTest, names of frames, and flights.
#include <cmath>
#include <sstream>
#include <vector>

#include "Flight.h"
#include "FrameName.h"
#include "FrameSchedule.h"
#include "Input.h"
#include "Options.h"

namespace {

constexpr std::string_view kFlightSeed =
    "time_ms,x,y,z,qx,qy,qz,qw\n0,0,0,1,0,0,0,1\n40,0.5,0.25,1e3,0.1,-0.2,0.3,0.9\n80,1,1,1,0,0,1,0\n";
constexpr std::string_view kOptionSeeds[] = {
    "-h\nmap.png\n-t\ntexture.jpg\n-a\nroam\n-c\n-v\n-e\n1.5\n-r\n20000\n--spacing\n10,5\n--height-scale\n0.01\n-A\n10000\n-"
    "F\n40\n-s",
    "--scene\ndata/terrain.iv\n--offscreen=800x600\n--output\nframe-%04d.png\n--frames\n60\n-p\nprofile.csv\n--record\nflight.csv",
    "-h\nmap.raw\n--raw-size\n513x257\n--raw-type\nuint16be\n--channel\n2\n--flight\nflight.csv\n--measure-error\n10\n--stats\n-f",
    "-h\nmap.tif\n-a\nclipmap\n--clipmap-size\n255\n--levels\n3\n--detail\n2\n-g\n16\n--help\n--version",
};

void runFlight(std::string_view text) {
    std::istringstream stream{std::string(text)};
    const auto flight = app::readFlight(stream, "flight.csv");
    if (!flight) return fuzz::check(!flight.error().message().empty(), "an error without a word");
    const double duration = flight.value().duration();
    fuzz::check(std::isfinite(duration) && duration >= 0.0, "a flight that takes no number of milliseconds");
    for (const double time : fuzz::kNumbers) {
        flight.value().at(time);
        if (time > 0.0 && std::isfinite(time)) flight.value().lasting(time).at(0.5 * time);
    }
    flight.value().at(0.3 * duration);
}

void runOptions(std::string_view text) {
    std::vector<std::string> words{"SoTerrainTest"};
    std::istringstream stream{std::string(text)};
    for (std::string word; std::getline(stream, word);) words.push_back(word.substr(0, word.find('\0')));
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const auto options = app::parseOptions(int(words.size()), arguments.data());
    if (!options) return fuzz::check(!options.error().message().empty(), "an error without a word");
    const app::Options& found = options.value();
    const auto schedule = app::FrameSchedule::make(found.animationTime.value_or(app::Options::defaultAnimationTime),
                                                   found.frameTime, found.frames, found.synchronize);
    int last = -1;
    for (const double elapsed : {0.0, 1.0, 1e4, 1e12})
        if (const auto next = schedule.next(last, elapsed)) {
            fuzz::check(next->frame > last, "time runs backwards");
            last = next->frame;
        }
}

void runFrameName(std::string_view text) {
    const std::string pattern(text);
    if (app::checkFrameName(pattern)) return;
    for (const int frame : {0, 7, std::numeric_limits<int>::max()}) app::frameName(pattern, frame);
}

}  // namespace

int LLVMFuzzerInitialize(int*, char***) {
    fuzz::writeSeed("flight", "F" + std::string(kFlightSeed));
    fuzz::writeSeed("name", "Nframe-%04d.png");
    int number = 0;
    for (const std::string_view seed : kOptionSeeds) fuzz::writeSeed("options" + std::to_string(number++), "O" + std::string(seed));
    return 0;
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
    switch (data[0]) {
    case 'F':
        runFlight(text);
        break;
    case 'N':
        runFrameName(text);
        break;
    default:
        runOptions(text);
    }
    return 0;
}
