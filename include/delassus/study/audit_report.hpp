/// What an audit says: each effect, whether it acted, and what its rows cost.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/status.hpp>
#include <delassus/io/table.hpp>
#include <delassus/math/pose.hpp>
#include <delassus/schemes/error_report.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// What may act.
enum class Effect : std::uint8_t { contact /**< λ_n */, friction /**< λ_t */, rolling /**< moments */, restitution /**< bounces */, joint /**< one item */, body /**< motion */ };
/// Whether it did.
enum class Verdict : std::uint8_t {
  acted,  ///< at least once
  held,   ///< friction that acted and never slipped: any larger coefficient does the same
  never,  ///< the run would have been the same without
};

/// As tables print it.
constexpr const char* name(Effect effect) {
  constexpr const char* names[] = {"contact", "friction", "rolling friction", "restitution", "joint", "body"};
  return inner::name_in(names, effect);
}
/// The same of a verdict.
constexpr const char* name(Verdict verdict) {
  constexpr const char* names[] = {"acted", "held, never slipped", "never"};
  return inner::name_in(names, verdict);
}

/// One effect of one law, joint or body.
struct EffectUse {
  Effect effect;  ///< its kind
  std::string name;  ///< of the law, or the body
  int place = -1;    ///< of a joint in its pool
  Verdict verdict = Verdict::never;  ///< over the whole run
  long acted = 0;    ///< constraints × steps in which it acted
  long present = 0;  ///< constraints × steps in which it was there
  double work = 0;   ///< visits of its rows: Σ rows × (sweeps + factorizations)
};

/// Where a body was at the end, to compare two runs.
struct AuditedBody {
  int set;  ///< place of its set in World{...}
  Index block;  ///< of that set
  Vec3 position;  ///< at the end, m, world
};

/// The inner steps of a run under `ErrorControlled` whose error one effect made.
struct StepCause {
  ErrorEffect effect = ErrorEffect::motion;  ///< its kind
  long steps = 0;                  ///< accepted
  long rejections = 0;             ///< tried in vain
  double least_step = 0;           ///< s, of the accepted ones
  double error = 0;  ///< the largest that was accepted in a step of the host which it ruled, in the unit of the accuracy
  std::string body;  ///< whose error that was
};

/// What a run used, and what it paid for.
struct AuditReport {
  long steps = 0;  ///< that were seen
  double work = 0;  ///< visits of rows, Σ rows × (sweeps + factorizations): no machine changes them
  std::vector<EffectUse> uses;  ///< laws in their order, then bodies
  std::vector<AuditedBody> bodies;  ///< all that move
  std::vector<StepCause> causes;  ///< of the size of inner steps, those that had any; none without `ErrorControlled`

  /// Those whose verdict is `never`.
  std::vector<EffectUse> unused() const {
    std::vector<EffectUse> out;
    for (const EffectUse& use : uses)
      if (use.verdict == Verdict::never) out.push_back(use);
    return out;
  }
  /// The share of the visits that goes with an effect, if the sweeps stay as they are. Not of the time: that
  /// has detection and the bodies in it too.
  double predicted_saving(const EffectUse& use) const { return work > 0 ? use.work / work : 0; }
};

/// What a run is without an effect, measured.
struct Without {
  double saving = 0;      ///< share of the work that is gone
  double difference = 0;  ///< largest distance of a body's place at the end, m, of bodies in both runs
};

/// `rerun()` makes the same scene without an effect, steps it as often, and returns the loop; an Audit{} is
/// in its list.
template <class F>
Without without(const AuditReport& with, F&& rerun) {
  const AuditReport bare = audit(rerun());
  DELASSUS_EXPECT(bare.steps == with.steps, "without: the second run took " + std::to_string(bare.steps) +
                                                " steps, the first " + std::to_string(with.steps) +
                                                "; they must be as many");
  Without out{.saving = with.work > 0 ? 1 - bare.work / with.work : 0, .difference = 0};
  for (const AuditedBody& a : with.bodies)
    for (const AuditedBody& b : bare.bodies)
      if (a.set == b.set && a.block == b.block)
        out.difference = std::max(out.difference, (a.position - b.position).norm());
  return out;
}

/// One row an effect; what never acted first.
inline Table audit_table(const AuditReport& report) {
  Table table{.title = "Effects of a run of " + std::to_string(report.steps) + " steps",
              .caption =
                  "Share: of visits of rows, what would go with the effect. Restitution and bodies have no "
                  "rows of their own.",
              .columns = {"effect", "of", "verdict", "acted", "present", "share of work (%)"}};
  for (const bool is_first : {true, false})
    for (const EffectUse& use : report.uses) {
      if ((use.verdict == Verdict::never) != is_first) continue;
      table.add({name(use.effect), use.place >= 0 ? use.name + " #" + std::to_string(use.place) : use.name,
                 name(use.verdict), use.acted, use.present, Cell(100 * report.predicted_saving(use), 3)});
    }
  return table;
}

/// What set the size of the inner steps: one row an effect.
inline Table step_table(const AuditReport& report) {
  Table table{.title = "What set the size of the steps",
              .columns = {"effect", "steps", "repeated", "smallest step (s)", "largest error", "of"}};
  for (const StepCause& cause : report.causes)
    table.add({name(cause.effect), cause.steps, cause.rejections, Cell(cause.least_step, 3), Cell(cause.error, 3), cause.body});
  return table;
}

namespace inner {

struct PoolUse {
  std::string name;
  int rows = 0;
  bool is_contact = false, has_friction = false, has_rolling = false, has_restitution = false;
  long items = 0, acted = 0, held = 0, slipped = 0, rolled = 0, bounced = 0;
  double work = 0;
  std::vector<long> loaded, seen;  ///< by place of a joint: steps
};
struct BodyUse {
  std::string name;
  int set;
  Index block;
  Pose start, end;
  bool has_moved;
};
struct AuditSeen {
  long steps = 0;
  std::vector<PoolUse> pools;
  std::vector<BodyUse> bodies;
  std::array<StepCause, 4> causes{};  ///< in the order of `ErrorEffect`
};

inline Verdict verdict_of(long acted) { return acted > 0 ? Verdict::acted : Verdict::never; }

inline void append_contact(std::vector<EffectUse>& uses, const PoolUse& pool) {
  uses.push_back({Effect::contact, pool.name, -1, verdict_of(pool.acted), pool.acted, pool.items, pool.work});
  if (pool.has_friction) {
    const Verdict verdict = pool.slipped > 0 ? Verdict::acted
                            : pool.held > 0  ? Verdict::held
                                             : Verdict::never;
    uses.push_back({Effect::friction, pool.name, -1, verdict, pool.held, pool.items,
                    pool.work * (pool.rows - 1) / pool.rows});
  }
  if (pool.has_rolling)
    uses.push_back({Effect::rolling, pool.name, -1, verdict_of(pool.rolled), pool.rolled, pool.items,
                    pool.work * (pool.rows - 3) / pool.rows});
  if (pool.has_restitution)
    uses.push_back(
        {Effect::restitution, pool.name, -1, verdict_of(pool.bounced), pool.bounced, pool.items, 0});
}

/// A joint's share of its pool's work is that of its steps.
inline void append_joints(std::vector<EffectUse>& uses, const PoolUse& pool) {
  for (std::size_t place = 0; place < pool.seen.size(); ++place)
    if (pool.seen[place] > 0)
      uses.push_back({Effect::joint, pool.name, int(place), verdict_of(pool.loaded[place]),
                      pool.loaded[place], pool.seen[place],
                      pool.work * double(pool.seen[place]) / double(pool.items)});
}

inline AuditReport audit_report(const AuditSeen& seen) {
  AuditReport report{.steps = seen.steps};
  for (const PoolUse& pool : seen.pools) {
    report.work += pool.work;
    if (pool.is_contact)
      append_contact(report.uses, pool);
    else
      append_joints(report.uses, pool);
  }
  for (const BodyUse& body : seen.bodies) {
    report.uses.push_back({Effect::body, body.name, -1, verdict_of(body.has_moved), body.has_moved, 1, 0});
    report.bodies.push_back({body.set, body.block, body.end.position});
  }
  for (std::size_t k = 0; k < seen.causes.size(); ++k)
    if (seen.causes[k].steps + seen.causes[k].rejections > 0) {
      report.causes.push_back(seen.causes[k]);
      report.causes.back().effect = ErrorEffect(k);
    }
  return report;
}

}  // namespace inner
}  // namespace delassus
