#include "Meters.h"

#include <dirent.h>
#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <functional>

namespace soak {

namespace {

// Sanitizers keep what was freed.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryTells = false;
#else
constexpr bool kMemoryTells = true;
#endif

double statusOf(const char* key) {
    double value = 0.0;
    if (std::FILE* file = std::fopen("/proc/self/status", "r")) {
        char line[256];
        while (std::fgets(line, sizeof line, file))
            if (std::strncmp(line, key, std::strlen(key)) == 0) value = std::atof(line + std::strlen(key));
        std::fclose(file);
    }
    return value;
}

int openFiles() {
    int count = 0;
    if (DIR* folder = opendir("/proc/self/fd")) {
        while (readdir(folder)) ++count;
        closedir(folder);
    }
    return count - 3;  // ".", ".." and the folder itself
}

}  // namespace

Reading readProcess(bool trim) {
    if (trim) malloc_trim(0);
    Reading reading;
    constexpr double kMega = 1 << 20;
    reading.residentMegabytes = statusOf("VmRSS:") / 1024.0;
    const auto heap = mallinfo2();
    reading.heapMegabytes = double(heap.uordblks + heap.hblkhd) / kMega;
    reading.threads = int(statusOf("Threads:"));
    reading.files = openFiles();
    return reading;
}

Table::Table(const std::string& path, const std::vector<std::string>& glKinds) : path_(path) {
    if (path.empty()) return;
    file_ = std::fopen(path.c_str(), "w");
    if (!file_) return;
    std::fprintf(file_, "seconds,at rest,resident MB,heap MB,GL MB,threads,files,mean frame ms,longest frame ms");
    for (const std::string& kind : glKinds) std::fprintf(file_, ",%s", kind.c_str());
    std::fprintf(file_, ",kept by Coin MB\n");
}

Table::~Table() {
    if (file_) std::fclose(file_);
}

void Table::add(const Reading& r) {
    if (!file_) return;
    std::fprintf(file_, "%.1f,%d,%.2f,%.3f,%.2f,%d,%d,%.2f,%.2f", r.seconds, r.atRest, r.residentMegabytes, r.heapMegabytes,
                 r.glMegabytes, r.threads, r.files, r.meanFrameMilliseconds, r.longestFrameMilliseconds);
    for (const std::size_t count : r.glObjects) std::fprintf(file_, ",%zu", count);
    std::fprintf(file_, ",%.3f\n", r.coinMegabytes);
    std::fflush(file_);
}

void Table::plot(const std::string& picture) {
    if (!file_ || picture.empty()) return;
    if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) {
        std::printf("no plot: gnuplot is missing\n");
        return;
    }
    std::FILE* gnuplot = popen("gnuplot", "w");
    if (!gnuplot) return;
    const bool isPng = picture.size() > 4 && picture.compare(picture.size() - 4, 4, ".png") == 0;
    std::fprintf(
        gnuplot,
        "set terminal %s size 1000,900\nset output '%s'\nset datafile separator ','\nset key left top\nset grid\n"
        "set multiplot layout 3,1\nset ylabel 'MB'\n"
        "plot '%s' every ::1 using 1:3 with lines title 'resident', '' every ::1 using 1:4 with lines title 'heap in use', "
        "'' every ::1 using 1:5 with lines title 'GL, as reported'\n"
        "set title 'all nodes and contexts gone' offset 0,-1\n"
        "plot '%s' every ::1 using ($2==1?$1:1/0):3 with points pt 7 ps 0.5 title 'resident', "
        "'' every ::1 using ($2==1?$1:1/0):4 with points pt 5 ps 0.5 title 'heap in use'\n"
        "unset title\nset ylabel 'count'\nset xlabel 'seconds'\n"
        "plot '%s' every ::1 using 1:10 with lines title 'buffers', '' every ::1 using 1:11 with lines title 'textures', "
        "'' every ::1 using 1:15 with lines title 'programs', '' every ::1 using 1:6 with lines title 'threads', "
        "'' every ::1 using 1:7 with lines title 'open files'\n",
        isPng ? "pngcairo" : "svg", picture.c_str(), path_.c_str(), path_.c_str(), path_.c_str());
    if (pclose(gnuplot) != 0) std::printf("no plot: gnuplot failed\n");
}

double growth(const std::vector<double>& series) {
    std::vector<double> slopes;
    for (std::size_t i = 0; i < series.size(); ++i)
        for (std::size_t j = i + 1; j < series.size(); ++j) slopes.push_back((series[j] - series[i]) / double(j - i));
    if (slopes.empty()) return 0.0;
    const auto middle = slopes.begin() + std::ptrdiff_t(slopes.size() / 2);
    std::nth_element(slopes.begin(), middle, slopes.end());
    return *middle * double(series.size() - 1);
}

std::string verdict(const std::vector<Reading>& atRest, const std::vector<std::string>& glKinds, int& grew) {
    const std::size_t first = atRest.size() / 4;
    std::string text;
    grew = 0;
    const auto judge = [&](const std::string& name, const char* unit, Tolerance tolerance,
                           const std::function<double(const Reading&)>& value) {
        std::vector<double> series;
        for (std::size_t i = first; i < atRest.size(); ++i) series.push_back(value(atRest[i]));
        const double by = growth(series), allowed = tolerance.share * series.front() + tolerance.besides;
        const bool grows = by > allowed && (kMemoryTells || *unit == 0);
        grew += grows;
        char line[256];
        std::snprintf(line, sizeof line, "  %-16s %9.2f ... %9.2f %s, trend over the run %+.2f (at most %.2f): %s\n", name.c_str(),
                      series.front(), series.back(), unit, by, allowed, grows ? "GREW" : "flat");
        text += line;
    };
    if (atRest.size() - first < 4) {
        grew = 1;
        return "  too short: four readings at rest are needed after the warm-up\n";
    }
    // What Coin and the GL driver keep of names and compiled code levels off slowly.
    judge("resident", "MB", {0.02, 6.0}, [](const Reading& r) { return r.residentMegabytes - r.coinMegabytes; });
    judge("heap in use", "MB", {0.005, 0.5}, [](const Reading& r) { return r.heapMegabytes - r.coinMegabytes; });
    judge("threads", "", {0.0, 1.5}, [](const Reading& r) { return double(r.threads); });
    judge("open files", "", {0.0, 1.5}, [](const Reading& r) { return double(r.files); });
    for (std::size_t kind = 0; kind < glKinds.size(); ++kind) {
        std::size_t most = 0;
        for (const Reading& reading : atRest) most = std::max(most, reading.glObjects[kind]);
        if (most == 0) continue;
        text += "  GL " + glKinds[kind] + ": up to " + std::to_string(most) + " where all nodes and contexts are gone: LEFT\n";
        ++grew;
    }
    if (text.find("LEFT") == std::string::npos) text += "  GL objects       none left whenever all was gone\n";
    return text;
}

}  // namespace soak
