#include "case/joined_bed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "particles/geometry.hpp"

namespace talus {
namespace {

using Surface = std::span<const Vec2>;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Height at x on the right of a vertical face there.
double height_after(Surface s, double x) {
  const auto next = std::ranges::upper_bound(s, x, {}, &Vec2::x);
  const Vec2 last = *(next - 1);
  return last.x == x || next == s.end() ? last.y : height_at(last, *next, x);
}

/// Height at x on the left of a vertical face there.
double height_before(Surface s, double x) {
  const auto next = std::ranges::lower_bound(s, x, {}, &Vec2::x);
  return next->x == x || next == s.begin() ? next->y : height_at(*(next - 1), *next, x);
}

bool has_vertex(Surface s, Vec2 v) {
  const auto [first, last] = std::ranges::equal_range(s, v.x, {}, &Vec2::x);
  return std::find(first, last, v) != last;
}

/// Part of a surface.
struct Stretch {
  Surface surface;
  double from, to;
};
using Stretches = std::vector<Stretch>;

void append(Stretches& all, const Stretch& next) {
  if (next.from >= next.to) return;
  if (!all.empty() && all.back().surface.data() == next.surface.data() && all.back().to == next.from)
    all.back().to = next.to;
  else
    all.push_back(next);
}

/// What lies between lo and hi.
void append(Stretches& all, const Stretches& from, double lo, double hi) {
  for (const Stretch& s : from) append(all, {s.surface, std::max(s.from, lo), std::min(s.to, hi)});
}

/// The ground, and the slip surface where it lies below.
Stretches lower_of(Surface ground, Surface slip) {
  const double begin = std::max(ground.front().x, slip.front().x), end = std::min(ground.back().x, slip.back().x);
  std::vector<double> x = {begin, end};
  for (const Surface s : {ground, slip})
    for (const Vec2& v : s)
      if (v.x > begin && v.x < end) x.push_back(v.x);
  std::ranges::sort(x);
  Stretches lower;
  append(lower, {ground, ground.front().x, begin});
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    if (x[k] == x[k + 1]) continue;
    const double left = height_after(slip, x[k]) - height_after(ground, x[k]);
    const double right = height_before(slip, x[k + 1]) - height_before(ground, x[k + 1]);
    const double crossing = left * right < 0.0 ? x[k] + (x[k + 1] - x[k]) * left / (left - right) : x[k + 1];
    append(lower, {left < 0.0 || (left == 0.0 && right < 0.0) ? slip : ground, x[k], crossing});
    append(lower, {right < 0.0 ? slip : ground, crossing, x[k + 1]});
  }
  append(lower, {ground, end, ground.back().x});
  return lower;
}

/// The surface beyond the slide where it has an extent.
Stretches with_beyond(const Stretches& bed, Surface beyond, const Box& slide) {
  const double first = beyond.front().x, last = beyond.back().x;
  Stretches all;
  append(all, bed, -infinite, std::min(first, slide.lo.x));
  append(all, {beyond, first, std::min(last, slide.lo.x)});
  append(all, bed, std::min(last, slide.lo.x), std::max(first, slide.hi.x));
  append(all, {beyond, std::max(first, slide.hi.x), last});
  append(all, bed, std::max(last, slide.hi.x), infinite);
  return all;
}

/// The stretches one after the other; where they meet with a gap of at most `closed` one vertex stands, a given one if
/// there is one.
std::vector<Vec2> line_of(const Stretches& stretches, double closed) {
  std::vector<Vec2> line;
  bool given = false;  // whether the last vertex of the line is one of the surface's
  for (const Stretch& s : stretches) {
    const Vec2 first{s.from, height_after(s.surface, s.from)}, last{s.to, height_before(s.surface, s.to)};
    const bool first_given = has_vertex(s.surface, first);
    const bool meets = !line.empty() && std::abs(line.back().y - first.y) <= closed;
    if (!meets)
      line.push_back(first);
    else if (first_given && (!given || first.y < line.back().y))
      line.back() = first;
    for (const Vec2& v : s.surface)
      if (v.x > s.from && v.x < s.to) line.push_back(v);
    line.push_back(last);
    given = has_vertex(s.surface, last);
  }
  return line;
}

}  // namespace

std::vector<Vec2> joined_bed(Surface ground, Surface slip, Surface beyond, const Box& slide) {
  Stretches bed = lower_of(ground, slip);
  if (!beyond.empty()) bed = with_beyond(bed, beyond, slide);
  constexpr double closed_gap = 1e-3;  // of the slip surface's extent
  return line_of(bed, closed_gap * (slip.back().x - slip.front().x));
}

}  // namespace talus
