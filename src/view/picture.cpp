#include "picture.h"

#include <algorithm>
#include <cmath>

#include "scenery.h"

namespace afm::view {
namespace {

using visualization_msgs::Marker;

// A picture takes so much of what is new, so that it costs the same at any speed, and shows it for a second.
constexpr std::size_t kNewImpacts = 40, kNewPositions = 64, kGlow = 30;
constexpr std::size_t kMostOfPath = 100000;
constexpr double kFollowed = 0.5;  // tau a picture
constexpr double kPathDepth = -0.02, kTipDepth = -0.06, kImpactDepth = -0.04,
                 kPositionDepth = -0.01;  // before the surface
constexpr double kImpactSize = 0.09, kPositionSize = 0.025, kConeHeight = 0.5, kConeRadius = 0.13;
constexpr double kOldest = 0.15;  // opacity of the oldest part of the path
constexpr int kConeSides = 16;

bool is_contact(ImpactKind kind) { return kind == ImpactKind::contact_begun || kind == ImpactKind::contact_ended; }

void draw_path(Canvas& canvas, const std::vector<Place>& path) {
  Marker& line = canvas.add("path", Marker::LINE_STRIP);
  line.scale.x = 0.03;
  if (path.size() < 2) return;
  for (const Place& p : path) {
    const double age = (path.back().time - p.time) / (path.back().time - path.front().time);
    line.points.push_back(canvas.place(p.x, p.y, kPathDepth));
    line.colors.push_back(p.contact ? contact_colour(1.0 - (1.0 - kOldest) * age)
                                    : flight_colour(1.0 - (1.0 - kOldest) * age));
  }
}

// The apex of the cone is where the tip is.
void draw_tip(Canvas& canvas, const Place& tip) {
  Marker& cone = canvas.add("tip", Marker::TRIANGLE_LIST);
  const geometry_msgs::Point apex = canvas.place(tip.x, tip.y, kTipDepth);
  const auto rim = [&](int i) {
    const double angle = kTwoPi * i / kConeSides;
    return point(apex.x + kConeRadius * std::cos(angle), apex.y + kConeRadius * std::sin(angle), apex.z + kConeHeight);
  };
  for (int i = 0; i < kConeSides; ++i) {
    for (const auto& corner : {apex, rim(i + 1), rim(i)}) cone.points.push_back(corner);
  }
  cone.color = tip.contact ? contact_colour() : tip_colour();
  canvas.add_text("contact", tip.contact ? "contact" : "", point(apex.x, apex.y, apex.z + kConeHeight + 0.15), 0.2);
}

void draw_spring(Canvas& canvas, const Place& tip, double holder_x, double holder_y) {
  Marker& lines = canvas.add("spring", Marker::LINE_LIST);
  const geometry_msgs::Point c = canvas.place(holder_x, holder_y, kPathDepth);
  const double arm = 0.07;
  lines.points = {c,
                  canvas.place(tip.x, tip.y, kPathDepth),
                  point(c.x - arm, c.y, c.z),
                  point(c.x + arm, c.y, c.z),
                  point(c.x, c.y, c.z - arm),
                  point(c.x, c.y, c.z + arm)};
  lines.scale.x = 0.015;
  lines.color = spring_colour();
}

}  // namespace

visualization_msgs::MarkerArray Picture::draw(const RunView& run, ros::Time stamp) {
  Canvas canvas(look_, stamp);
  if (!run.complete()) {
    canvas.wipe();
    canvas.add_text("time", "no messages from an emulator yet", point(0.0, 0.0, 0.5), 0.16);
    return canvas.finish();
  }
  const bool too_fast = run.configuration().time_scale / (kPictureRate * run.units().time()) > kFollowed;
  if (!too_fast) cloud_.clear();
  if (run.configuration().epoch != epoch_ || run.now() < seen_) {
    cloud_.clear();
    seen_ = run.now() + -kPathTau;
  }
  epoch_ = run.configuration().epoch;
  if (too_fast) {
    gather(run);
  } else {
    cloud_ = {{{}, run.impacts_since(run.now() + -kPathTau, kMostOfPath)}};
  }
  seen_ = run.now();
  // more is seen of where the tip came from than of where it goes
  const double eta = run.eta(), holder = run.holder_x(run.now()), ahead = std::floor(0.25 * look_.cells);
  canvas.set_origin((too_fast ? std::round(holder) : holder) - (eta > 0.0 ? ahead : eta < 0.0 ? -ahead : 0.0));
  draw_scenery(canvas, run, too_fast);
  draw_motion(canvas, run);
  draw_positions(canvas);
  draw_impacts(canvas, run.units(), too_fast);
  return canvas.finish();
}

void Picture::gather(const RunView& run) {
  cloud_.push_back({run.samples_since(seen_, kNewPositions), run.impacts_since(seen_, kNewImpacts)});
  if (cloud_.size() > kGlow) cloud_.pop_front();
}

// Its last part without a gap; impacts are corners of it.
void Picture::draw_motion(Canvas& canvas, const RunView& run) const {
  const ModelTime from = run.now() + -kPathTau;
  const auto samples = run.samples_since(from, kMostOfPath), impacts = run.impacts_since(from, kMostOfPath);
  std::vector<Place> path(samples.size() + impacts.size());
  std::merge(impacts.begin(), impacts.end(), samples.begin(), samples.end(), path.begin(),
             [](const Place& a, const Place& b) { return a.time < b.time; });
  const Place tip = path.back();
  const auto unseen = std::find_if(path.rbegin(), path.rend(), [&](const Place& p) { return !canvas.shows(p.x); });
  path.erase(path.begin(), unseen.base());
  draw_path(canvas, path);
  draw_spring(canvas, tip, run.holder_x(run.now()), run.holder_y(run.now()));
  draw_tip(canvas, tip);
}

void Picture::draw_positions(Canvas& canvas) const {
  Marker& dots = canvas.add("positions", Marker::POINTS);
  dots.scale.x = dots.scale.y = kPositionSize;
  std::size_t nth = 0;
  for (const Puff& puff : cloud_) {
    for (const Place& p : puff.positions) {
      dots.points.push_back(canvas.place(canvas.over_cell(p.x, nth++), p.y, kPositionDepth));
      dots.colors.push_back(p.contact ? contact_colour() : flight_colour(0.55));
    }
  }
}

// `scattered`: on a surface that stands still every cell is like every other, and the nth is drawn over the nth cell.
void Picture::draw_impacts(Canvas& canvas, const Units& units, bool scattered) const {
  Marker impacts = canvas.marker("impacts", Marker::SPHERE_LIST),
         contacts = canvas.marker("contacts", Marker::CUBE_LIST);
  const EnergyScale scale(units.energy());
  std::size_t nth = 0;
  for (const Puff& puff : cloud_) {
    for (const Place& p : puff.impacts) {
      const double x = scattered ? canvas.over_cell(p.x, nth++) : p.x;
      if (!canvas.shows(x)) continue;
      Marker& where = is_contact(p.kind) ? contacts : impacts;
      where.points.push_back(canvas.place(x, p.y, kImpactDepth));
      where.colors.push_back(is_contact(p.kind) ? contact_colour()
                                                : EnergyScale::colour_at(scale.place(p.energy_loss)));
    }
  }
  for (Marker* marker : {&impacts, &contacts}) {
    marker->scale.x = marker->scale.y = marker->scale.z = kImpactSize;
    canvas.add(*marker);
  }
}

}  // namespace afm::view
