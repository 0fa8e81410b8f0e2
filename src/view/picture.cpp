#include "picture.h"

#include <algorithm>
#include <cmath>

namespace afm::view {
namespace {

// A picture takes so much of what is new, so that it costs the same at any speed, and shows it for a second.
constexpr std::size_t kNewImpacts = 40, kNewPositions = 64, kGlow = 30;
constexpr std::size_t kMostOfPath = 100000;
constexpr double kFollowed = 0.5;  // tau a picture
constexpr double kPositionDepth = -0.01, kPathDepth = -0.02, kImpactDepth = -0.04, kTipDepth = -0.06;
constexpr double kImpactSize = 0.09, kPositionSize = 0.025, kConeHeight = 0.5, kConeDiameter = 0.26;
constexpr double kOldest = 0.15;  // opacity of the oldest part of the path

// The last part that is in the picture without a gap. Impacts are corners of it.
void draw_path(Canvas& canvas, const std::vector<Place>& samples, const std::vector<Place>& impacts) {
  std::vector<Place> path(samples.size() + impacts.size());
  std::merge(impacts.begin(), impacts.end(), samples.begin(), samples.end(), path.begin(),
             [](const Place& a, const Place& b) { return a.time < b.time; });
  const auto unseen = std::find_if(path.rbegin(), path.rend(), [&](const Place& p) { return !canvas.shows(p.x); });
  path.erase(path.begin(), unseen.base());
  Marker& line = canvas.add("path", Marker::LINE_STRIP, flight_colour(), 0.03);
  if (path.size() < 2) return;
  const double length = path.back().time - path.front().time;
  for (const Place& p : path) {
    const double opacity = 1.0 - (1.0 - kOldest) * (path.back().time - p.time) / length;
    line.points.push_back(canvas.place(p.x, p.y, kPathDepth));
    line.colors.push_back(p.contact ? contact_colour(opacity) : flight_colour(opacity));
  }
}

// The apex of the cone is where the tip is, and a cross where its holder is.
void draw_tip(Canvas& canvas, const Place& tip, const Place& holder) {
  Marker& cone = canvas.add("tip", Marker::ARROW, tip.contact ? contact_colour() : tip_colour());
  const geometry_msgs::Point apex = canvas.place(tip.x, tip.y, kTipDepth);
  cone.points = {point(apex.x, apex.y, apex.z + kConeHeight), apex};
  cone.scale.x = 0.01;  // of a shaft that has no length
  cone.scale.y = kConeDiameter;
  cone.scale.z = kConeHeight;
  canvas.add_text("contact", tip.contact ? "contact" : "", point(apex.x, apex.y, apex.z + kConeHeight + 0.15), 0.2);
  const double arm = 0.07;
  const geometry_msgs::Point c = canvas.place(holder.x, holder.y, kPathDepth);
  canvas.add("spring", Marker::LINE_LIST, spring_colour(), 0.015).points = {c,
                                                                            canvas.place(tip.x, tip.y, kPathDepth),
                                                                            point(c.x - arm, c.y, c.z),
                                                                            point(c.x + arm, c.y, c.z),
                                                                            point(c.x, c.y, c.z - arm),
                                                                            point(c.x, c.y, c.z + arm)};
}

// `scattered`: on a surface that stands still every cell is like every other, and the nth is drawn over the nth cell.
void draw_impacts(Canvas& canvas, const std::vector<Place>& places, double energy_unit, bool scattered) {
  Marker& impacts = canvas.add("impacts", Marker::SPHERE_LIST, tip_colour(), kImpactSize);
  Marker& contacts = canvas.add("contacts", Marker::CUBE_LIST, contact_colour(), kImpactSize);
  for (std::size_t nth = 0; nth < places.size(); ++nth) {
    const Place& p = places[nth];
    const double x = scattered ? canvas.over_cell(p.x, nth) : p.x;
    if (!canvas.shows(x)) continue;
    if (p.kind == ImpactKind::contact_begun || p.kind == ImpactKind::contact_ended) {
      contacts.points.push_back(canvas.place(x, p.y, kImpactDepth));
      contacts.colors.push_back(contact_colour());
    } else {
      impacts.points.push_back(canvas.place(x, p.y, kImpactDepth));
      impacts.colors.push_back(colour_on_scale(place_on_scale(p.energy_loss, energy_unit)));
    }
  }
}

void draw_positions(Canvas& canvas, const std::vector<Place>& places) {
  Marker& dots = canvas.add("positions", Marker::POINTS, flight_colour(), kPositionSize);
  for (std::size_t nth = 0; nth < places.size(); ++nth) {
    const Place& p = places[nth];
    dots.points.push_back(canvas.place(canvas.over_cell(p.x, nth), p.y, kPositionDepth));
    dots.colors.push_back(p.contact ? contact_colour() : flight_colour(0.55));
  }
}

// Adds to a cloud what is new, and takes away what is older than its glow.
void renew(std::deque<std::vector<Place>>& cloud, std::vector<Place> places) {
  cloud.push_back(std::move(places));
  if (cloud.size() > kGlow) cloud.pop_front();
}

std::vector<Place> all_of(const std::deque<std::vector<Place>>& cloud) {
  std::vector<Place> places;
  for (const auto& part : cloud) places.insert(places.end(), part.begin(), part.end());
  return places;
}

}  // namespace

visualization_msgs::MarkerArray Picture::draw(const RunView& run, ros::Time stamp) {
  if (!run.complete()) {
    Canvas nothing(cells_, 0.0, stamp);
    nothing.add("all", Marker::CUBE, tip_colour()).action = Marker::DELETEALL;  // whatever earlier pictures left
    // rviz draws no text that is alone
    nothing.add("path", Marker::LINE_STRIP, text_colour(), 0.02).points = {point(-1.6, 0.0, 0.3), point(1.6, 0.0, 0.3)};
    nothing.add_text("time", "no messages from an emulator yet", point(0.0, 0.0, 0.5), 0.16);
    return nothing.finish();
  }
  const ModelTime now = run.now(), path_begin = now + -kPathTau;
  const bool too_fast = run.configuration().time_scale / (kPictureRate * run.units().time()) > kFollowed;
  if (run.configuration().epoch != epoch_ || now < seen_) {
    positions_.clear();
    impacts_.clear();
    seen_ = path_begin;
  }
  const auto samples = run.samples_since(path_begin, kMostOfPath), impacts = run.impacts_since(path_begin, kMostOfPath);
  if (too_fast) {
    renew(positions_, run.samples_since(seen_, kNewPositions));
    renew(impacts_, run.impacts_since(seen_, kNewImpacts));
  }
  epoch_ = run.configuration().epoch;
  seen_ = now;
  // a run that has stood still for a second is followed
  const std::vector<Place> positions = all_of(positions_);
  const bool is_cloud = too_fast && !positions.empty();
  // more is seen of where the tip came from than of where it goes
  const double eta = run.eta(), ahead = std::floor(0.25 * cells_) * (eta > 0.0 ? 1.0 : eta < 0.0 ? -1.0 : 0.0);
  const Place holder = run.holder();
  Canvas canvas(cells_, (is_cloud ? std::round(holder.x) : holder.x) - ahead, stamp);
  draw_scenery(canvas, run, is_cloud);
  draw_path(canvas, samples, impacts);
  draw_tip(canvas, samples.back(), holder);
  draw_positions(canvas, positions);
  draw_impacts(canvas, is_cloud ? all_of(impacts_) : impacts, run.units().energy(), is_cloud);
  return canvas.finish();
}

}  // namespace afm::view
