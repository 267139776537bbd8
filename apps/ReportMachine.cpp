#include "Report.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

#include <Inventor/SoDB.h>
#include <SoTerrain/SoTerrain.h>

#include "ChildProcess.h"

namespace app {

namespace {

// What stands after `key` and a colon or an equals sign in the first line that begins with it.
std::string firstMatch(const char* path, const std::string& key) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with(key)) continue;
        const std::size_t sign = line.find_first_of(":=");
        const std::size_t begin = sign == std::string::npos ? sign : line.find_first_not_of(" \t\"", sign + 1);
        if (begin == std::string::npos) return {};
        line.erase(line.find_last_not_of(" \t\"") + 1);
        return line.substr(begin);
    }
    return {};
}

std::string firstLine(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

}  // namespace

double loadAverage() {
    double load = 0.0;
    return getloadavg(&load, 1) == 1 ? load : 0.0;
}

Facts describeMachine(const ReportPlan& plan) {
    Facts facts;
    const std::string processor = firstMatch("/proc/cpuinfo", "model name");
    const unsigned threads = std::thread::hardware_concurrency();
    facts.emplace_back("Processor", (processor.empty() ? "unknown" : processor) + ", " + std::to_string(threads) +
                                        (threads == 1 ? " thread" : " threads"));
    const double pages = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
    facts.emplace_back("Memory", format(pages / (1024.0 * 1024.0 * 1024.0), 1) + " GB");
    for (const Measurement& m : plan.measurements) {
        if (!m.measured()) continue;
        facts.emplace_back("GL renderer", m.result["renderer"].get<std::string>());
        facts.emplace_back("GL version", m.result["gl_version"].get<std::string>());
        break;
    }
    utsname system{};
    const std::string name = firstMatch("/etc/os-release", "PRETTY_NAME");
    if (uname(&system) == 0)
        facts.emplace_back("System",
                           (name.empty() ? "" : name + ", ") + system.sysname + " " + system.release + " " + system.machine);
    facts.emplace_back("SoTerrain", SoTerrain::getVersion());
    facts.emplace_back("Coin", SoDB::getVersion());
    facts.emplace_back("Compiler", "g++ " __VERSION__);
    facts.emplace_back("Plots", firstLine(runProcess({"gnuplot", "--version"}).out));
    char date[64] = "";
    const std::time_t now = std::time(nullptr);
    if (const std::tm* local = std::localtime(&now)) std::strftime(date, sizeof date, "%Y-%m-%d %H:%M", local);
    facts.emplace_back("Date", date);
    return facts;
}

}  // namespace app
