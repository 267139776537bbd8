/*!
  \class SoPerfGraph SoPerfGraph.h SoTerrain/SoPerfGraph.h
  \brief The SoPerfGraph class draws scrolling graphs of what frames take over a scene.

  Every graph follows one counter, a point for each frame, the latest one at its right. On top stand the counter's name and its latest value
  with the unit, below the name the top of the scale. The node draws in the pixels of the viewport, over everything else in the scene
  wherever it stands, transparent objects and annotations before it included:

  \code
  #Inventor V2.1 ascii
  Separator {
    SoHeightMap { filename "terrain.png" }
    SoROAMTerrain { }
    SoPerfGraph { counter [ "fps", "triangles", "selection", "memory" ] }
  }
  \endcode

  It needs no terrain: any Coin scene has "fps" and "frame", and programs count what they like by count() and set(). Counters that are there
  without further ado:

  <table>
  <tr><th>name</th><th>unit</th><th>what it shows</th></tr>
  <tr><td>fps</td><td>/s</td><td>frames in a second, by the time between two frames of this node in this view</td></tr>
  <tr><td>frame</td><td>ms</td><td>that time</td></tr>
  <tr><td>selection</td><td>ms</td><td>terrain nodes: choosing their meshes</td></tr>
  <tr><td>upload</td><td>ms</td><td>terrain nodes: filling buffers and textures</td></tr>
  <tr><td>drawing</td><td>ms</td><td>terrain nodes: GL's drawing calls, as the calling thread sees them</td></tr>
  <tr><td>building</td><td>ms</td><td>terrain nodes: preparing height data that is new or has changed, in frames that do it; and new tiles, also of other threads</td></tr>
  <tr><td>triangles</td><td></td><td>terrain nodes: triangles sent to GL</td></tr>
  <tr><td>draw calls</td><td></td><td>terrain nodes: calls of GL for them</td></tr>
  <tr><td>patches</td><td></td><td>terrain nodes: parts that are drawn at one level each</td></tr>
  <tr><td>splits</td><td></td><td>terrain nodes: refinements of meshes</td></tr>
  <tr><td>merges</td><td></td><td>terrain nodes: coarsenings of meshes</td></tr>
  <tr><td>sent</td><td>B</td><td>terrain nodes: bytes sent to GL</td></tr>
  <tr><td>memory</td><td>B</td><td>terrain nodes: main memory that they hold</td></tr>
  <tr><td>buffers</td><td>B</td><td>terrain nodes: GL's memory that they hold</td></tr>
  <tr><td>error</td><td>px</td><td>the bound on the screen error of the terrain node that was drawn last</td></tr>
  <tr><td>resident</td><td>B</td><td>main memory of the whole process</td></tr>
  </table>

  What several terrain nodes count adds up, but for the error. Amounts are those since the frame of this view before: where several views
  are drawn, each shows the work for all of them. A time of more than 2 seconds between two frames is a rest and no frame's time. The node
  asks for no frames: a picture at rest rests.

  Six graphs of the default size take 1.8 % of the processor's instructions for a frame of 1024 x 768 pixels of SoROAMTerrain over data/terrain.png
  where Mesa's llvmpipe draws it, and about 1.3 % where nothing is rasterised.

  GL and Coin's state are afterwards what they were, and nothing of them acts on graphs: lights, textures, shader programs, clip planes, fog,
  draw styles. They are drawn with fixed functions of GL 1.1, without a buffer object; a context of GL's core profile has none, and no
  graphs. Under an SoShadowGroup they would be drawn into shadow maps, too: put them behind it.

  <b>FILE FORMAT/DEFAULTS:</b>
  \code
    SoPerfGraph {
      counter [ "selection", "upload", "building", "triangles", "fps", "memory" ]
      maximum 0
      color [ 0.4 0.9 0.4, 1 0.8 0.3, 1 0.5 0.4, 0.4 0.8 1, 1 1 0.5, 0.8 0.6 1 ]
      position 8 8
      size 120 44
      scale 1
      columns 0
      history 120
      transparency 0.35
      on TRUE
    }
  \endcode

  \sa SoTerrainShape::getStatistics
*/

/*!
  \var SoMFString SoPerfGraph::counter
  Names of counters, one graph each. An empty name leaves its place free; one that nothing counts by shows "-". The default is the time for
  evaluation of the mesh, for filling buffers and for new tiles, the number of triangles, frames in a second, and memory.
*/
/*!
  \var SoMFFloat SoPerfGraph::maximum
  Top of each graph's scale, in the counter's unit. 0, the default, or none: 1, 2 or 5 times a power of ten, so that all that is shown fits. The scale begins
  at 0, or below it where values are.
*/
/*!
  \var SoMFColor SoPerfGraph::color
  Colour of each curve and name; where there are fewer than graphs, from the first again. By default they are
  green, orange, red, blue, yellow and violet.
*/
/*!
  \var SoSFVec2f SoPerfGraph::position
  Where graphs are, in pixels from the lower left corner of the viewport; a negative number is taken from the right or upper border.
  Default 8 8.
*/
/*!
  \var SoSFVec2f SoPerfGraph::size
  Width and height of a graph in pixels. In a viewport that has less, graphs have less. Text that does not fit is left out. Default 120 44.
*/
/*!
  \var SoSFFloat SoPerfGraph::scale
  Pixels for each one of position and size, and for those of text, of which there are whole ones. Displays of high density want 2. Default 1.
*/
/*!
  \var SoSFInt32 SoPerfGraph::columns
  Graphs side by side, row above row, or below, where position counts from the upper border. 0, the default: as many as fit.
*/
/*!
  \var SoSFInt32 SoPerfGraph::history
  Frames across a graph, from 2 to 65536, by default 120. Where these are more than pixels, the least and the largest value for each pixel are shown.
*/
/*!
  \var SoSFFloat SoPerfGraph::transparency
  Of the dark ground behind the curves: 0 hides the scene, 1 is none. Default 0.35.
*/
/*!
  \var SoSFBool SoPerfGraph::on
  Whether graphs are drawn. Default TRUE. While they are not, the node costs nothing, and counters are not looked at.
*/

#include <epoxy/gl.h>

#include <SoTerrain/SoPerfGraph.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <Inventor/SoPath.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoCacheElement.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/misc/SoState.h>

#include "FieldsInUse.h"
#include "OverlayPool.h"
#include "PerfGraphView.h"
#include "TerrainCounters.h"

SO_NODE_SOURCE(SoPerfGraph);

namespace {

float within(float value, float low, float high, float otherwise)
{
    return std::isnan(value) ? otherwise : std::clamp(value, low, high);
}

std::uint8_t byteOf(float share)
{
    return std::uint8_t(std::lround(255.0f * within(share, 0.0f, 1.0f, 0.0f)));
}

}  // namespace

class SoPerfGraph::Private {
public:
    explicit Private(SoPerfGraph * m) : master(m) {}

    /// The view that is being drawn comes to be the last one.
    PerfGraphView & viewOf(SoGLRenderAction * action);
    PerfLayout layoutFor(const SbVec2s & viewport) const;
    void addFrame(PerfGraphView & view);
    void draw(SoGLRenderAction * action);
    void warnOnce(const std::string & text);

    SoPerfGraph * master;
    std::vector<std::unique_ptr<PerfGraphView>> views;
    std::set<std::string> warned;

private:
    /// Fields as they are used.
    void readFields();

    SbUniqueId read = 0;  ///< node id at the time
    std::vector<std::string> names;
    std::vector<double> maxima;
    std::vector<PerfGraphStyle> styles;
    std::size_t history = 2;
};

void SoPerfGraph::Private::readFields()
{
    if (read == master->getNodeId()) return;
    read = master->getNodeId();
    names.clear();
    maxima.clear();
    styles.clear();
    const int colors = master->color.getNum();
    const terrain::OverlayColor ground = {0, 0, 0, byteOf(1.0f - within(master->transparency.getValue(), 0.0f, 1.0f, 0.0f))};
    for (int i = 0; i < master->counter.getNum(); ++i) {
        const SbColor color = colors > 0 ? master->color[i % colors] : SbColor(1.0f, 1.0f, 1.0f);
        names.push_back(master->counter[i].getString());
        styles.push_back({{byteOf(color[0]), byteOf(color[1]), byteOf(color[2]), 255}, ground});
    }
    for (int i = 0; i < master->maximum.getNum(); ++i) maxima.push_back(double(master->maximum[i]));
    history = std::size_t(std::clamp(master->history.getValue(), 2, 65536));
}

PerfGraphView & SoPerfGraph::Private::viewOf(SoGLRenderAction * action)
{
    const ViewKey key(action);
    const auto found = std::find_if(views.begin(), views.end(), [&key](const auto & view) { return view->key == key; });
    if (found != views.end()) {
        std::rotate(found, found + 1, views.end());
        return *views.back();
    }
    constexpr std::size_t kMost = 16;
    if (views.size() >= kMost) views.erase(views.begin());
    // Where only the viewport differs the window has probably got another size: its graphs go on.
    const auto before = std::find_if(views.rbegin(), views.rend(), [&key](const auto & view) { return view->key.hasPlaceOf(key); });
    views.push_back(before != views.rend() ? std::make_unique<PerfGraphView>(**before) : std::make_unique<PerfGraphView>(key));
    views.back()->key = key;
    views.back()->isNew = true;
    return *views.back();
}

PerfLayout SoPerfGraph::Private::layoutFor(const SbVec2s & viewport) const
{
    constexpr float kFar = 1e5f, kLargest = 16384.0f;
    const float scale = within(master->scale.getValue(), 0.25f, 16.0f, 1.0f);
    const SbVec2f place = master->position.getValue(), size = master->size.getValue();
    PerfLayout layout;
    layout.position = {within(place[0], -kFar, kFar, 8.0f) * scale, within(place[1], -kFar, kFar, 8.0f) * scale};
    layout.size = {within(size[0], 1.0f, kLargest, 120.0f) * scale, within(size[1], 1.0f, kLargest, 44.0f) * scale};
    layout.viewport = {std::max<int>(viewport[0], 1), std::max<int>(viewport[1], 1)};
    layout.gap = std::floor(6.0f * scale);
    layout.columns = std::max(0, master->columns.getValue());
    layout.textScale = std::max(1, int(std::lround(scale)));
    layout.fit();
    return layout;
}

void SoPerfGraph::Private::addFrame(PerfGraphView & view)
{
    readFields();
    const bool isRenewed = view.isNew || view.fields != read;
    if (isRenewed) view.follow(names);
    const PerfLayout layout = layoutFor(view.key.viewportSize);
    view.addFrame(history, layout.size.x, maxima);
    view.arrange(layout, styles, isRenewed);
    view.isNew = false;
    view.fields = read;
    view.hasFrame = true;
    for (const std::string & name : view.unknownNames())
        warnOnce("counter: expected a name that something counts by (fps, frame, resident, " + PerfCounters::instance().names() + "), found \"" + name + "\"");
}

void SoPerfGraph::Private::draw(SoGLRenderAction * action)
{
    PerfGraphView & view = viewOf(action);
    if (!view.hasFrame) addFrame(view);
    view.hasFrame = false;
    if (!view.draw(*overlayResourcesOf(action->getState()), layoutFor(view.key.viewportSize)))
        warnOnce("expected a GL context with fixed functions and room on its stacks, found none; no graphs are drawn");
}

void SoPerfGraph::Private::warnOnce(const std::string & text)
{
    if (warned.insert(text).second) SoDebugError::postWarning("SoPerfGraph", "%s", text.c_str());
}

void SoPerfGraph::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    TerrainCounters::declare();
    SO_NODE_INIT_CLASS(SoPerfGraph, SoNode, "Node");
}

SoPerfGraph::SoPerfGraph() : pimpl(new Private(this))
{
    static const char * const counters[] = {"selection", "upload", "building", "triangles", "fps", "memory"};
    static const SbColor colors[] = {{0.4f, 0.9f, 0.4f}, {1.0f, 0.8f, 0.3f}, {1.0f, 0.5f, 0.4f},
                                     {0.4f, 0.8f, 1.0f}, {1.0f, 1.0f, 0.5f}, {0.8f, 0.6f, 1.0f}};
    SO_NODE_CONSTRUCTOR(SoPerfGraph);
    SO_NODE_ADD_FIELD(counter, (""));
    SO_NODE_ADD_FIELD(maximum, (0.0f));
    SO_NODE_ADD_FIELD(color, (1.0f, 1.0f, 1.0f));
    SO_NODE_ADD_FIELD(position, (8.0f, 8.0f));
    SO_NODE_ADD_FIELD(size, (120.0f, 44.0f));
    SO_NODE_ADD_FIELD(scale, (1.0f));
    SO_NODE_ADD_FIELD(columns, (0));
    SO_NODE_ADD_FIELD(history, (120));
    SO_NODE_ADD_FIELD(transparency, (0.35f));
    SO_NODE_ADD_FIELD(on, (TRUE));
    this->counter.setNum(6);
    for (int i = 0; i < 6; ++i) this->counter.set1Value(i, counters[i]);
    this->counter.setDefault(TRUE);
    this->color.setValues(0, 6, colors);
    this->color.setDefault(TRUE);
}

SoPerfGraph::~SoPerfGraph() {}

void SoPerfGraph::count(const char * name, double amount, const char * unit)
{
    PerfCounter & counter = PerfCounters::instance().declare(name ? name : "", PerfCounter::AMOUNT, unit);
    if (std::isfinite(amount)) counter.count(amount);
}

void SoPerfGraph::set(const char * name, double value, const char * unit)
{
    PerfCounters::instance().declare(name ? name : "", PerfCounter::VALUE, unit).set(value);
}

SbBool SoPerfGraph::getShown(int index, double & value, double & top) const
{
    if (pimpl->views.empty()) return FALSE;
    const PerfGraphView & view = *pimpl->views.back();
    if (index < 0 || index >= int(view.size())) return FALSE;
    value = view.plotOf(std::size_t(index)).value();
    top = view.plotOf(std::size_t(index)).top();
    return TRUE;
}

void SoPerfGraph::notify(SoNotList * list)
{
    if (list->getLastField()) pimpl->warned.clear();
    inherited::notify(list);
}

void SoPerfGraph::write(SoWriteAction * action)
{
    if (!writeFieldsInUse(action, this)) inherited::write(action);
}

SbBool SoPerfGraph::affectsState() const
{
    return FALSE;
}

void SoPerfGraph::GLRender(SoGLRenderAction * action)
{
    if (!this->on.getValue()) {
        for (const auto & view : pimpl->views) view->rest();
        return;
    }
    SoGLCacheContextElement::shouldAutoCache(action->getState(), SoGLCacheContextElement::DONT_AUTO_CACHE);
    SoCacheElement::invalidate(action->getState());
    if (action->isRenderingDelayedPaths()) {
        pimpl->draw(action);
        return;
    }
    // A frame may be made of several passes. Values are those of now; drawing waits until all else is drawn.
    if (action->getCurPass() == 0) pimpl->addFrame(pimpl->viewOf(action));
    action->addDelayedPath(action->getCurPath()->copy());
}
