/// What of a recording goes into a page: which frames, which contacts, and how coarse the series.
#pragma once

#include <delassus/io/recording.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace delassus::inner {

/// Frames per second and contacts per frame that are kept, at most.
struct ReplayPlan {
  double frames_per_second = 30;
  std::size_t contacts = 256;
};

/// A plotted series has at most this many points.
inline constexpr std::size_t replay_samples = 1200;

/// The first frame of every interval of 1/rate.
inline std::vector<std::size_t> kept_frames(const Recording& recording, double rate) {
  std::vector<std::size_t> kept;
  rate = std::min(rate, recording.frames_per_second);
  for (std::size_t f = 0; f < recording.frames.size(); ++f) {
    const double due = double(kept.size()) - 1e-6;
    if (f == 0 || (recording.frames[f].time - recording.frames[0].time) * rate > due) kept.push_back(f);
  }
  return kept;
}

/// The `most` contacts of largest impulse, in their own order. A contact that is not finite is left out.
inline std::vector<std::size_t> kept_contacts(const RecordedFrame& frame, std::size_t most) {
  std::vector<std::size_t> kept;
  for (std::size_t c = 0; c < frame.contacts.size(); ++c)
    if (is_finite(frame.contacts[c].point) && is_finite(frame.contacts[c].impulse)) kept.push_back(c);
  if (kept.size() <= most) return kept;
  const auto larger = [&](std::size_t a, std::size_t b) {
    const double ia = frame.contacts[a].impulse.squaredNorm(), ib = frame.contacts[b].impulse.squaredNorm();
    return ia != ib ? ia > ib : a < b;
  };
  std::nth_element(kept.begin(), kept.begin() + std::ptrdiff_t(most), kept.end(), larger);
  kept.resize(most);
  std::sort(kept.begin(), kept.end());
  return kept;
}

/// Bytes of the frames in base64: 6 for a position, 6 for a rotation, 13 for a contact, 12 for a line.
inline std::size_t planned_bytes(const Recording& recording, const ReplayPlan& plan) {
  std::size_t moving = 0, turning = 0, bytes = 0;
  for (const RecordedBody& body : recording.bodies) {
    moving += !body.is_static;
    turning += !body.is_static && !body.is_particle;
  }
  for (const std::size_t f : kept_frames(recording, plan.frames_per_second)) {
    const RecordedFrame& frame = recording.frames[f];
    bytes += 14 + 6 * moving + 6 * turning + 13 * std::min(frame.contacts.size(), plan.contacts) +
             12 * frame.lines.size();
  }
  return bytes * 4 / 3;
}

/// What a page holds of its recordings besides frames, at most: words, series, shapes and bodies.
inline std::size_t bytes_beside_frames(std::span<const Recording> recordings) {
  std::size_t bytes = 1000;
  for (const Recording& r : recordings) {
    const std::size_t samples = std::min(r.steps.time.size(), replay_samples);
    bytes +=
        2000 + 6 * (r.name.size() + r.caption.size()) + (4 + r.steps.stages.size()) * (samples * 8 / 3 + 100);
    for (const RecordedBody& body : r.bodies) {
      bytes += 180 + 45 * body.vertices.size();
      for (const auto& face : body.faces) bytes += 2 + 7 * face.size();
    }
  }
  return bytes;
}

/// The finest plan whose frames fit in `bytes`: first fewer contacts, then fewer frames. The coarsest if none
/// fits.
inline ReplayPlan plan_for(std::span<const Recording> recordings, std::size_t bytes) {
  ReplayPlan plan;
  for (const double rate : {30.0, 20.0, 15.0, 10.0}) {
    for (const std::size_t contacts : {256, 192, 128, 96, 64, 32}) {
      plan = {rate, contacts};
      const auto add = [&](std::size_t sum, const Recording& r) { return sum + planned_bytes(r, plan); };
      if (std::accumulate(recordings.begin(), recordings.end(), std::size_t(0), add) <= bytes) return plan;
    }
  }
  return plan;
}

/// How many steps one plotted point stands for.
inline std::size_t steps_per_sample(std::size_t steps) {
  return std::max<std::size_t>(1, (steps + replay_samples - 1) / replay_samples);
}

enum class Keep { last, largest, mean };

/// One value for every `width` values; nan and inf are passed over while there is a finite one.
inline std::vector<double> reduced(std::span<const double> values, std::size_t width, Keep keep) {
  std::vector<double> out;
  for (std::size_t start = 0; start < values.size(); start += width) {
    double sum = 0, largest = -std::numeric_limits<double>::infinity(), last = values[start];
    int count = 0;
    for (const double x : values.subspan(start, std::min(width, values.size() - start))) {
      if (!std::isfinite(x)) continue;
      sum += x;
      largest = std::max(largest, x);
      last = x;
      ++count;
    }
    out.push_back(count == 0              ? values[start]
                  : keep == Keep::mean    ? sum / count
                  : keep == Keep::largest ? largest
                                          : last);
  }
  return out;
}

}  // namespace delassus::inner
