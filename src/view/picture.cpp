#include "picture.h"

#include <algorithm>
#include <cmath>

#include "afm/surface.h"
#include "palette.h"
#include "scenery.h"
#include "tip_markers.h"

namespace afm::view {
namespace {

using visualization_msgs::Marker;

constexpr double kImpactDepth = -0.04, kPositionDepth = -0.01;
constexpr double kImpactSize = 0.09, kPositionSize = 0.025;

bool is_contact(ImpactKind kind) { return kind == ImpactKind::contact_begun || kind == ImpactKind::contact_ended; }

// How far from the middle the holder is, so that more is seen of where the tip came from than of where it goes.
double cells_ahead(const Look& look, double eta) {
  const double cells = std::floor(0.25 * look.cells);
  return eta > 0.0 ? cells : eta < 0.0 ? -cells : 0.0;
}

// The path up to a moment, which becomes its last corner.
std::vector<Corner> until(const ModelTime& moment, std::vector<Corner> path) {
  const auto after = std::upper_bound(path.begin(), path.end(), moment,
                                      [](const ModelTime& time, const Corner& corner) { return time < corner.time; });
  if (after == path.begin() || after == path.end()) return path;
  const Corner a = *std::prev(after), b = *after;
  const double part = (moment - a.time) / (b.time - a.time);
  path.erase(after, path.end());
  if (a.time < moment) path.push_back({moment, a.x + part * (b.x - a.x), a.y + part * (b.y - a.y), a.contact});
  return path;
}

// Its last part without a gap.
void clip(const Canvas& canvas, std::vector<Corner>& path) {
  const auto unseen = std::find_if(path.rbegin(), path.rend(), [&](const Corner& c) { return !canvas.shows(c.x); });
  path.erase(path.begin(), unseen.base());
}

}  // namespace

visualization_msgs::MarkerArray Picture::draw(RunView& run, ros::Time stamp) {
  Canvas canvas(look_, stamp);
  if (!run.complete()) {
    canvas.wipe();
    canvas.add_text("time", "no messages from an emulator yet", point(0.0, 0.0, 0.5), 0.16);
    return canvas.finish();
  }
  strobe_.look(run);
  canvas.set_origin(strobe_.origin() - cells_ahead(look_, run.holder().eta(run.now())));
  afterglow_.look(run, strobe_);
  draw_surface(canvas, run.model());
  draw_motion(canvas, run);
  draw_positions(canvas);
  draw_impacts(canvas, run.units());
  draw_length_scale(canvas, run.units());
  draw_key(canvas, run.units());
  draw_figures(canvas, run, strobe_);
  return canvas.finish();
}

void Picture::draw_motion(Canvas& canvas, const RunView& run) const {
  const ModelTime& moment = strobe_.moment();
  auto path = until(moment, run.trace().path(moment + -kPathTau, run.model(), run.holder()));
  if (path.empty()) return;
  const Corner tip = path.back();
  clip(canvas, path);
  draw_path(canvas, path);
  draw_spring(canvas, tip, run.holder().position(moment), run.holder().height(moment));
  draw_tip(canvas, tip);
}

// On a surface that stands still every cell is like every other: what is nth is drawn over the nth of the cells seen.
double Picture::drawn_x(const Canvas& canvas, const Spot& spot, std::size_t nth) const {
  if (!strobe_.frozen()) return spot.corner.x;
  const auto cells = static_cast<std::size_t>(look_.cells);
  return canvas.left() + static_cast<double>(nth % cells) + wrap_phase(spot.corner.x - canvas.left());
}

void Picture::draw_positions(Canvas& canvas) const {
  Marker& dots = canvas.add("positions", Marker::POINTS);
  dots.scale.x = dots.scale.y = kPositionSize;
  std::size_t nth = 0;
  for (const Spot& spot : afterglow_.positions()) {
    const double x = drawn_x(canvas, spot, nth++);
    if (!canvas.shows(x)) continue;
    dots.points.push_back(canvas.place(x, spot.corner.y, kPositionDepth));
    dots.colors.push_back(spot.corner.contact ? contact_colour() : flight_colour(0.55));
  }
}

void Picture::draw_impacts(Canvas& canvas, const Units& units) const {
  Marker& impacts = canvas.add("impacts", Marker::SPHERE_LIST);
  impacts.scale.x = impacts.scale.y = impacts.scale.z = kImpactSize;
  Marker contacts = impacts;
  const EnergyScale scale(units.energy());
  std::size_t nth = 0;
  for (const Spot& spot : afterglow_.impacts()) {
    const double x = drawn_x(canvas, spot, nth++);
    if (!canvas.shows(x)) continue;
    Marker& where = is_contact(spot.kind) ? contacts : impacts;
    where.points.push_back(canvas.place(x, spot.corner.y, kImpactDepth));
    where.colors.push_back(EnergyScale::colour_at(scale.place(spot.energy * units.energy())));
  }
  contacts.ns = "contacts";
  contacts.type = Marker::CUBE_LIST;
  for (auto& colour : contacts.colors) colour = contact_colour();
  canvas.add(contacts.ns, contacts.type) = contacts;
}

}  // namespace afm::view
