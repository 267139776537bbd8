"""Compares the page, the CSV and the JSON of a report with each other and with what the benchmark measured: report.py FOLDER BENCH.json"""
import csv
import json
import math
import re
import sys
from html.parser import HTMLParser

folder, bench_file = sys.argv[1:]
failures = []


def check(condition, what):
    if not condition:
        failures.append(what)


class Page(HTMLParser):
    """Rows of the table, plots, pictures and references of the page."""

    def __init__(self):
        super().__init__()
        self.rows, self.cell, self.references, self.plots, self.pictures, self.ids, self.unlabelled = [], None, [], 0, 0, [], 0
        self.in_table = self.in_body = False
        self.open = []

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag not in ("meta", "img", "br", "wbr", "link", "path", "circle", "rect", "use", "feflood", "fecomposite"):
            self.open.append(tag)
        self.references += [attributes[name] for name in ("src", "href", "xlink:href", "action", "data") if name in attributes]
        if "id" in attributes:
            self.ids.append(attributes["id"])
        if tag == "svg":
            self.plots += 1
            self.unlabelled += not attributes.get("aria-label")
        if tag == "img":
            self.pictures += 1
            self.unlabelled += not attributes.get("alt")
        if tag == "table":
            self.in_table = attributes.get("id") == "nodes"
        if tag == "tbody":
            self.in_body = self.in_table
        if self.in_body and tag == "tr":
            self.rows.append([])
        if self.in_body and tag in ("th", "td"):
            self.rows[-1].append("")
            self.cell = self.rows[-1]

    def handle_endtag(self, tag):
        if tag in self.open:
            while self.open.pop() != tag:
                failures.append(f"<{tag}> ends before what is in it")
        if tag in ("th", "td"):
            self.cell = None
        if tag == "table":
            self.in_table = self.in_body = False

    def handle_data(self, data):
        if self.cell is not None:
            self.cell[-1] += data


with open(folder + "/report.html", encoding="utf-8") as file:
    text = file.read()
page = Page()
page.feed(text)
with open(folder + "/report.csv", encoding="utf-8", newline="") as file:
    table = list(csv.DictReader(file))
with open(folder + "/report.json", encoding="utf-8") as file:
    report = json.load(file)
with open(bench_file, encoding="utf-8") as file:
    bench = {one["class"]: one for one in json.load(file)}

# The page needs nothing else.
check(not re.search(r"https?:|@import|<script|<link", text), "the page refers to something outside")
check(not re.search(r"url\((?!#)", text), "the page's style refers to something outside")
check(all(r.startswith(("data:", "#")) for r in page.references), f"references: {[r[:60] for r in page.references]}")
check(all(r[1:] in page.ids for r in page.references if r.startswith("#")), "a reference within the page leads nowhere")
check(len(page.ids) == len(set(page.ids)), "an id is there twice")
check(not re.search(r"\b(nan|inf|null)\b", re.sub(r"base64,[^\"]*", "", text), re.I), "a figure is no number")
check(page.unlabelled == 0, "a picture or a plot has no text for who does not see it")
check(page.plots == 8, f"{page.plots} plots instead of 8")
check(page.pictures in (0, 1 + 2 * 8), f"{page.pictures} pictures instead of 17, or none without OpenImageIO")
check(not page.open, f"elements that do not end: {page.open}")

# Page, CSV and JSON say the same. The first measurements are the rows of the table.
figures = [name for name in table[0] if name not in ("measurement", "class", "fields", "pixel_error", "columns", "rows", "problem", "frames")]
where = {
    "frame_ms_median": ("frame_ms", "median"), "frame_ms_p95": ("frame_ms", "p95"), "frame_ms_worst": ("frame_ms", "worst"),
    "cpu_ms_median": ("cpu_ms", "median"), "triangles": ("triangles",), "error_px_rms": ("error_px", "rms"),
    "error_px_p999": ("error_px", "p999"), "error_px_max": ("error_px", "max"), "bound_px": ("bound_px",),
    "growth_bytes_a_sample": ("growth_bytes",), "memory_bytes_a_sample": ("memory_bytes",), "buffer_bytes_a_sample": ("buffer_bytes",),
    "start_ms": ("start_ms",), "sent_kb": ("sent_bytes",)}
check(sorted(figures) == sorted(where), f"columns: {figures}")
coin = ("SoIndexedFaceSet", "SoQuadMesh")
untold = ("bound_px", "memory_bytes_a_sample", "buffer_bytes_a_sample", "sent_kb")
check(len(page.rows) == 9, f"{len(page.rows)} rows instead of 9")
check(len(table) == len(report["measurements"]), "CSV and JSON have not the same number of measurements")
for cells, line, measured in zip(page.rows, table, report["measurements"]):
    name = line["class"]
    check(cells[0] == name + line["fields"], f"{cells[0]} in the page is {name} in the CSV")
    check(measured["request"]["class"] == name, f"{name} in the CSV is another in the JSON")
    if name == "SoNoSuch<Node":
        check("SoNoSuch<Node: expected" in cells[1] and line["problem"] and measured["problem"], "no reason for SoNoSuch<Node")
        continue
    check(len(cells) == 1 + len(figures), f"{name}: {len(cells)} cells")
    for cell, figure in zip(cells[1:], figures):
        if name in coin and figure in untold:
            check(cell == "–" and line[figure] == "", f"{name}: {figure}")
            continue
        check(cell.replace(",", "") == line[figure], f"{name}: {figure} is {cell} in the page, {line[figure]} in the CSV")
        value = measured["result"]
        for key in where[figure]:
            value = value[key]
        value /= measured["result"]["samples"] if figure.endswith("_a_sample") else 1024 if figure == "sent_kb" else 1
        digits = len(line[figure].partition(".")[2])
        check(math.isfinite(value) and abs(value - float(line[figure])) <= 0.5001 * 10.0**-digits, f"{name}: {figure} is {value} in the JSON")

# The same triangles and errors as the benchmark, to the last bit. A clipmapSize of 255 is the default.
for measured in report["measurements"][:8]:
    name, result = measured["request"]["class"], measured["result"]
    if measured["request"]["fields"] == "clipmapSize 127":
        continue
    for key in ("triangles", "error_px", "samples_in_view", "not_drawn"):
        check(result[key] == bench[name][key], f"{name}: {key} is {result[key]}, in the benchmark {bench[name][key]}")
    if name in coin + ("SoBruteForceTerrain",):
        check(result["triangles"] == 8192, f"{name} does not draw 8192 triangles")

for failure in failures:
    print("FAIL:", failure)
sys.exit(bool(failures))
