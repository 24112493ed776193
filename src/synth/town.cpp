// SPDX-License-Identifier: LGPL-2.1-or-later
// A town on hills: streets in two directions, curves, crossings, traffic, and a round trip.
#include <algorithm>

#include "src/synth/scene_makers.h"
#include "src/synth/street.h"
#include "src/synth/terrain.h"
#include "src/synth/town_route.h"

namespace lidar::synth {
namespace {

/// Streets whose middle is farther from the sensor than this have only houses, because the houses
/// hide everything else.
constexpr double kInSight = 75;
constexpr float kCornerFree = 10.5F;  // no shape is nearer to the middle of a crossing [m]
// The houses of the other street are within this distance of the middle of a crossing [m].
constexpr float kCornerHouse = 27;
// The depth of houses below the ground, so that they have no gap at a hillside [m].
constexpr float kCellar = 1;
constexpr float kTrafficReach = 90;  // there are no people and cars further away [m]
constexpr float kSteep = -0.15F;     // rays with a lower slope soon meet the road
constexpr float kTooNear = 9;        // least distance between traffic and the sensor [m]

/// A street of the plan. It runs along u at a constant v, or along v at a constant u.
struct Line {
  bool along_u;
  std::int64_t number;
  double aside() const { return kFirstCrossing + kCrossingSpacing * static_cast<double>(number); }
  Terrain::Point PlanAt(double along, double left) const {
    return along_u ? Terrain::Point{along, aside() + left} : Terrain::Point{aside() - left, along};
  }
};

/// The position of a point on the plan, relative to the nearest crossing.
struct OnPlan {
  float u, v;
  bool road() const { return std::abs(u) < kStreetHalfRoad || std::abs(v) < kStreetHalfRoad; }
};

/// The ground around an anchor, and the streets on it.
struct Surroundings {
  explicit Surroundings(const View& view)
      : land(view.anchor_x, view.anchor_y), u(Phase(view.anchor_x)), v(Phase(view.anchor_y)) {}

  OnPlan Locate(float x, float y) const {
    constexpr auto kSpacing = static_cast<float>(kCrossingSpacing);
    const auto from_crossing = [](float phase, float local) {
      return kSpacing * (Fraction(phase + local / kSpacing) - 0.5F);
    };
    return {from_crossing(u, land.PlanU(x, y)), from_crossing(v, land.PlanV(x, y))};
  }
  static float Phase(double anchor) {
    const double phase = (anchor - kFirstCrossing) / kCrossingSpacing + 0.5;
    return static_cast<float>(phase - std::floor(phase));
  }

  Terrain::Local land;
  float u, v;  // position between two crossings, in units of kCrossingSpacing; 0.5 at a crossing
};

class Town final : public Scene {
 public:
  explicit Town(std::uint64_t seed) : Scene(seed) {}

  TrajectorySettings Lane(double speed_mps) const override {
    TrajectorySettings lane;
    lane.speed_mps = speed_mps;
    lane.sway_m = 0.15;
    lane.route = std::make_shared<TownRoute>(speed_mps);
    return lane;
  }
  void AddStatic(const View& view, std::vector<Shape>* shapes) const override;
  void AddMoving(const View& view, const Instant& now, std::vector<Shape>* shapes) const override;
  bool IntersectGround(const View& view, const Ray& ray, Random* noise, Hit* hit) const override;
  bool GroundFirst(const Ray& ray) const override { return ray.slope < kSteep; }
  void MoveTo(const View& view) override { around_ = Surroundings(view); }

 private:
  template <class Add>
  void ForEachLine(const View& view, const Add& add) const;
  Street StreetOf(const Line& line) const {
    return Street(Mix(seed() + 2 * static_cast<std::uint64_t>(line.number) + line.along_u));
  }

  Surroundings around_{View{}};
};

/// Moves shapes from a straight street along x to their positions in the town.
void BendInto(const View& view, const Line& line, double straight_anchor, std::size_t first,
              std::vector<Shape>* shapes) {
  for (std::size_t i = first; i < shapes->size(); ++i) {
    Shape& s = (*shapes)[i];
    const double along = straight_anchor + static_cast<double>(s.center.x);
    const auto left = static_cast<double>(s.center.y);
    const Terrain::Point at = Terrain::FromPlan(line.PlanAt(along, left));
    const Terrain::Point ahead = Terrain::DirectionAt(at, line.along_u);
    const double length = std::sqrt(ahead.a * ahead.a + ahead.b * ahead.b);
    const auto c = static_cast<float>(ahead.a / length);
    const auto sn = static_cast<float>(ahead.b / length);
    s.center = {static_cast<float>(at.a - view.anchor_x), static_cast<float>(at.b - view.anchor_y),
                s.center.z + static_cast<float>(Terrain::At(at).height)};
    const float cos_yaw = s.cos_yaw;
    s.cos_yaw = c * cos_yaw - sn * s.sin_yaw;
    s.sin_yaw = sn * cos_yaw + c * s.sin_yaw;
    const Vec3 v = s.velocity;
    s.velocity = {c * v.x - sn * v.y, sn * v.x + c * v.y, v.z};
    if (s.surface == Surface::kFacade) {
      s.center.z -= kCellar / 2;
      s.half.z += kCellar / 2;
    }
  }
}

/// Returns the distance from `along` to the middle of the nearest crossing.
float FromCrossing(double along) {
  return static_cast<float>(std::abs(std::remainder(along - kFirstCrossing, kCrossingSpacing)));
}

/// Removes the shapes that are in the other street of a crossing, or in that street's houses.
void ClearCrossings(const Line& line, double straight_anchor, std::size_t first,
                    std::vector<Shape>* shapes) {
  const auto in_the_way = [&](const Shape& s) {
    const float distance = FromCrossing(straight_anchor + static_cast<double>(s.center.x));
    if (distance < kCornerFree) return true;
    return !line.along_u && distance < kCornerHouse && std::abs(s.center.y) > kPavementEnd - 1;
  };
  shapes->erase(std::remove_if(shapes->begin() + static_cast<std::ptrdiff_t>(first), shapes->end(),
                               in_the_way),
                shapes->end());
}

/// Calls add(line, straight, distance) for each street in view. In the view `straight`, the street
/// runs along x. `distance` is the distance from the anchor to the street.
template <class Add>
void Town::ForEachLine(const View& view, const Add& add) const {
  const Terrain::Point here = Terrain::ToPlan({view.anchor_x, view.anchor_y});
  const auto radius = static_cast<double>(view.radius);
  for (const bool along_u : {true, false}) {
    const double aside = along_u ? here.b : here.a;
    const auto number = [&](double at) {
      return static_cast<std::int64_t>(std::ceil((at - kFirstCrossing) / kCrossingSpacing));
    };
    for (std::int64_t i = number(aside - radius); i < number(aside + radius); ++i) {
      const Line line{along_u, i};
      const double distance = std::abs(line.aside() - aside);
      View straight = view;
      straight.anchor_x = along_u ? here.a : here.b;
      straight.anchor_y = 0;
      straight.radius = static_cast<float>(std::sqrt(radius * radius - distance * distance)) + 10;
      add(line, straight, distance);
    }
  }
}

void Town::AddStatic(const View& view, std::vector<Shape>* shapes) const {
  ForEachLine(view, [&](const Line& line, const View& straight, double distance) {
    const Street street = StreetOf(line);
    const std::size_t first = shapes->size();
    for (const float side : {-1.0F, 1.0F}) {
      street.AddHouses(straight, side, shapes);
      if (distance > kInSight) continue;
      street.AddParked(straight, side, shapes);
      street.AddFurniture(straight, side, shapes);
    }
    ClearCrossings(line, straight.anchor_x, first, shapes);
    BendInto(view, line, straight.anchor_x, first, shapes);
  });
}

void Town::AddMoving(const View& view, const Instant& now, std::vector<Shape>* shapes) const {
  const auto ego_x = static_cast<float>(now.ego_x - view.anchor_x);
  const auto ego_y = static_cast<float>(now.ego_y - view.anchor_y);
  const std::size_t begin = shapes->size();
  View near = view;
  near.radius = std::min(view.radius, kTrafficReach);
  ForEachLine(near, [&](const Line& line, const View& straight, double distance) {
    if (distance > kInSight) return;
    const Street street = StreetOf(line);
    const std::size_t first = shapes->size();
    street.AddWalkers(straight, now, shapes);
    ClearCrossings(line, straight.anchor_x, first, shapes);
    street.AddOncoming(straight, now, shapes);
    // The cars on the other lane are made in the same way, and then rotated by half a turn.
    const std::size_t back = shapes->size();
    View turned = straight;
    turned.anchor_x = -straight.anchor_x;
    Street(Mix(seed() ^ static_cast<std::uint64_t>(line.number))).AddOncoming(turned, now, shapes);
    for (std::size_t i = back; i < shapes->size(); ++i) {
      Shape& s = (*shapes)[i];
      s.center = {-s.center.x, -s.center.y, s.center.z};
      s.velocity = {-s.velocity.x, -s.velocity.y, 0};
      s.cos_yaw = -s.cos_yaw;
      s.sin_yaw = -s.sin_yaw;
    }
    BendInto(view, line, straight.anchor_x, first, shapes);
  });
  const auto too_near = [&](const Shape& s) {
    return (s.center.x - ego_x) * (s.center.x - ego_x) +
                   (s.center.y - ego_y) * (s.center.y - ego_y) <
               kTooNear * kTooNear &&
           s.velocity.x * s.velocity.x + s.velocity.y * s.velocity.y > 9;
  };
  shapes->erase(
      std::remove_if(shapes->begin() + static_cast<std::ptrdiff_t>(begin), shapes->end(), too_near),
      shapes->end());
}

/// Returns the distance at which the ray meets the hills, which are raised by `above`. Returns
/// `reach` if the ray does not meet them within this distance.
float MeetHills(const Terrain::Local& land, const Ray& ray, float above, float reach) {
  constexpr int kMostSteps = 20;
  constexpr float kClose = 0.001F;
  const float curvature = Terrain::Local::curvature() * ray.horizontal * ray.horizontal;
  float t = 0;
  for (int i = 0; i < kMostSteps && t < reach; ++i) {
    const float x = ray.origin.x + t * ray.direction.x;
    const float y = ray.origin.y + t * ray.direction.y;
    const auto ground = land.HeightAt(x, y);
    const float clearance = ray.origin.z + t * ray.direction.z - ground.z - above;
    if (clearance < kClose) return std::max(t, 0.0F);
    const float fall =
        ground.slope_x * ray.direction.x + ground.slope_y * ray.direction.y - ray.direction.z;
    // The new t is where the ray would meet ground that has the greatest curvature. Real ground is
    // lower, so the step skips no point of it.
    t += 2 * clearance / (fall + std::sqrt(fall * fall + 2 * curvature * clearance));
  }
  return reach;
}

float ReflectivityAt(const OnPlan& at) {
  if (!at.road()) return std::min(std::abs(at.u), std::abs(at.v)) < kPavementEnd ? 0.3F : 0.4F;
  const bool along_u = std::abs(at.v) < std::abs(at.u);
  return along_u ? Street::RoadReflectivity(kFirstCrossing + static_cast<double>(at.u), at.v)
                 : Street::RoadReflectivity(kFirstCrossing + static_cast<double>(at.v), -at.u);
}

bool Town::IntersectGround(const View&, const Ray& ray, Random* noise, Hit* hit) const {
  const Terrain::Local& land = around_.land;
  const float reach = hit->distance;
  const float top = MeetHills(land, ray, kStreetKerb, reach);
  if (top >= reach) return false;
  const auto at = [&](float t) {
    return around_.Locate(ray.origin.x + t * ray.direction.x, ray.origin.y + t * ray.direction.y);
  };
  const float grain = 0.9F + 0.2F * noise->Uniform();
  const auto ground =
      land.HeightAt(ray.origin.x + top * ray.direction.x, ray.origin.y + top * ray.direction.y);
  const float fall = std::max(
      1e-3F, ground.slope_x * ray.direction.x + ground.slope_y * ray.direction.y - ray.direction.z);
  OnPlan place = at(top);
  if (!place.road()) {
    *hit = {top, ReflectivityAt(place) * grain, fall};
    return true;
  }
  float road = top + kStreetKerb / fall;
  place = at(road);
  if (!place.road()) {  // the ray meets the kerb, which is between the two levels
    float before = top;
    for (int i = 0; i < 6; ++i) {
      const float middle = (before + road) / 2;
      (at(middle).road() ? before : road) = middle;
    }
    if (before >= reach) return false;
    *hit = {before, 0.35F * grain, std::max(std::abs(ray.direction.x), std::abs(ray.direction.y))};
    return true;
  }
  if (road >= reach) return false;
  *hit = {road, ReflectivityAt(place) * grain, fall};
  return true;
}

}  // namespace

std::unique_ptr<Scene> MakeTown(std::uint64_t seed) { return std::make_unique<Town>(seed); }

}  // namespace lidar::synth
