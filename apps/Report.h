// A report of what every node takes over one map: what to measure, figures, plots, and a page.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "BenchRun.h"

namespace app {

struct ReportOptions {
    BenchRequest request;            ///< map, texture, flight, placement, frames, pixelError and errorEvery of all measurements
    std::vector<std::string> nodes;  ///< classes; empty: all
    std::string folder;
    std::string work;      ///< a folder for what is needed on the way
    double minutes = 9.0;  ///< all is over by then
    bool quick = false;    ///< fewer measurements
    int columns = 0;       ///< of the map
    int rows = 0;
};

/// A row of the report's table: a class with its fields, and how plots draw it.
struct Subject {
    std::string className;
    std::string fields;
    std::string label;
    std::string color;    ///< "#rrggbb", to be told from the ground of a light and of a dark page
    bool dashed = false;  ///< of Coin, not of SoTerrain
};

struct Measurement {
    std::string label;
    BenchRequest request;
    int rank = 0;                   ///< those of a lower one are measured first
    double weight = 1.0;            ///< about how long it takes, relative to others
    nlohmann::ordered_json result;  ///< of runBench(); null when it failed or was left out
    std::string problem;            ///< why
    bool leftOut = false;           ///< because time was over
    bool measured() const { return !result.is_null(); }
};

enum class Chapter {
    Error,    ///< triangles against error
    Clipmap,  ///< clipmap sizes and numbers of levels
    Size,     ///< maps of several sizes
};

/// A measurement's place in a plot. One measurement may be in several.
struct Use {
    Chapter chapter = Chapter::Error;
    std::string curve;
    std::string color;
    bool dashed = false;
    double x = 0.0;
    std::string mark;  ///< what the point is called
    std::size_t measurement = 0;
};

/// Everything that a report measures. The first measurements are those of the subjects, in their order.
struct ReportPlan {
    std::vector<Subject> subjects;
    std::vector<Measurement> measurements;
    std::vector<Use> uses;
    double load = 0.0;     ///< loadAverage() before anything was measured
    double seconds = 0.0;  ///< that all measurements took

    const Measurement& of(const Subject& subject) const { return measurements[std::size_t(&subject - subjects.data())]; }
};
ReportPlan planReport(const ReportOptions& options);

/// Measures, and tells on stderr how far it is. What there is no time for has that as its problem. False when it was interrupted.
bool measureReport(const ReportOptions& options, ReportPlan& plan);

/// A column of the tables.
struct Figure {
    const char* group;  ///< head over neighbouring columns that have the same
    const char* head;
    const char* name;  ///< in CSV
    int digits;        ///< after the point
    bool lessIsBetter;
    std::optional<double> (*value)(const nlohmann::ordered_json& result);  ///< nothing where Coin's shapes don't tell
};
const std::vector<Figure>& reportFigures();
std::string format(double value, int digits);
/// 1234567 as 1,234,567.
std::string grouped(double value, int digits = 0);

/// A row for each measurement.
std::string reportTable(const ReportPlan& plan);
nlohmann::ordered_json reportJson(const ReportOptions& options, const ReportPlan& plan);

using Facts = std::vector<std::pair<std::string, std::string>>;
/// The machine and the versions of what takes part, as pairs of name and value.
Facts describeMachine(const ReportPlan& plan);
/// How many programs wanted a processor in the last minute; 0 where the system does not tell.
double loadAverage();

/// What was found, in sentences.
struct Finding {
    std::string head;   ///< "Fewest triangles"
    std::string value;  ///< "9,009"
    std::string unit;
    const Subject* subject = nullptr;
    std::string text;  ///< "233 times fewer than SoQuadMesh"
};
std::vector<Finding> findings(const ReportPlan& plan);
/// Which node was quickest; who kept pixelError and who did not.
std::string summarySentence(const ReportPlan& plan);
std::string errorSentence(const ReportOptions& options, const ReportPlan& plan);

/// A plot of a report.
struct Plot {
    std::string name;  ///< of files
    std::string title;
    std::string text;  ///< what was measured and how
    std::string alt;   ///< what is to be seen, for who does not see it
    struct Key {
        std::string name, color;
        bool dashed = false;
    };
    std::vector<Key> keys;
    std::string svg;  ///< an element for the page, without any name outside of it
};
/// Draws all plots with gnuplot. Error: it is not there, or fails.
terrain::Result<std::vector<Plot>> drawPlots(const ReportOptions& options, const ReportPlan& plan);

/// Text as HTML has it.
std::string escaped(const std::string& text);
/// The page, all in one file: pictures and plots are in it.
std::string reportPage(const ReportOptions& options, const ReportPlan& plan, const std::vector<Plot>& plots);

}  // namespace app
