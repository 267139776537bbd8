#include "TerrainCounters.h"

namespace {

/// The process's counters, looked up once.
struct Counters {
    static PerfCounter & amount(const char * name, const char * unit)
    {
        return PerfCounters::instance().declare(name, PerfCounter::AMOUNT, unit);
    }
    static PerfCounter & value(const char * name, const char * unit)
    {
        return PerfCounters::instance().declare(name, PerfCounter::VALUE, unit);
    }

    PerfCounter & selection = amount("selection", "ms");
    PerfCounter & upload = amount("upload", "ms");
    PerfCounter & drawing = amount("drawing", "ms");
    PerfCounter & building = amount("building", "ms");
    PerfCounter & triangles = amount("triangles", "");
    PerfCounter & drawCalls = amount("draw calls", "");
    PerfCounter & patches = amount("patches", "");
    PerfCounter & splits = amount("splits", "");
    PerfCounter & merges = amount("merges", "");
    PerfCounter & sent = amount("sent", "B");
    PerfCounter & memory = value("memory", "B");
    PerfCounter & buffers = value("buffers", "B");
    PerfCounter & error = value("error", "px");
};

/// Never deleted, as the counters themselves.
Counters & counters()
{
    static Counters * const all = new Counters;
    return *all;
}

}  // namespace

TerrainCounters::TerrainCounters() : memory_(counters().memory), buffers_(counters().buffers) {}

void TerrainCounters::declare()
{
    counters();
}

void TerrainCounters::publish(const SoTerrainStatistics & figures)
{
    Counters & all = counters();
    all.selection.count(figures.selectMilliseconds);
    all.upload.count(figures.uploadMilliseconds);
    all.drawing.count(figures.drawMilliseconds);
    all.building.count(figures.buildMilliseconds + figures.tileMilliseconds);
    all.triangles.count(figures.triangles);
    all.drawCalls.count(figures.drawCalls);
    all.patches.count(figures.patches);
    all.splits.count(figures.splits);
    all.merges.count(figures.merges);
    all.sent.count(double(figures.uploadedBytes));
    all.error.set(figures.errorPixels);
    memory_.set(double(figures.memoryBytes));
    buffers_.set(double(figures.bufferBytes));
}
