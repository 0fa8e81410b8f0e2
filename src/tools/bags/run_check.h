// A recorded run, simulated again and compared byte for byte. It begins at a snapshot, applies what was applied, splits
// the motion at every snapshot, and makes every message as the node does. A batch is advanced as the node advanced it;
// where batches are missing, the run goes on to the next one, as its motion does not depend on how it is divided.
#pragma once

#include <afm_emulator/Applied.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>
#include <afm_emulator/Snapshot.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "afm/run.h"
#include "message_difference.h"
#include "node/params/parameters.h"
#include "recording.h"

namespace afm::bags {

struct Difference {
  std::string topic;
  std::uint32_t seq = 0;  // of the message
  FieldDifference field;
  std::string time;          // to which the run has come
  std::string last_command;  // before it
};

// Counts of what was compared.
struct Extent {
  std::uint64_t batches = 0, deflections = 0, samples = 0, impact_arrays = 0, impacts = 0;
  std::uint64_t commands = 0, snapshots = 0, epochs = 0;
  // not compared, as the state before them is not known, or where they end
  std::uint64_t batches_unknown = 0, commands_unknown = 0, batches_without_friction = 0;
  double model_seconds = 0.0;
};

class RunCheck {
 public:
  using Progress = std::function<void(std::size_t done, std::size_t all)>;  // batches

  // Throws Problem where nothing can be compared. A time further away than most_gap [tau] is a fault of its message
  // rather than a gap: by default 44 hours at the paper's frequency, a choice.
  RunCheck(const Recording& recording, Progress progress, double most_gap = 1e9);

  // Up to the first difference. Throws what rosbag does where the bag is damaged.
  void run();

  const std::optional<Difference>& difference() const { return difference_; }
  const Extent& extent() const { return extent_; }
  // The lost messages, in words.
  std::vector<std::string> missing() const;

 private:
  // Something that took effect, or a snapshot: one of the two.
  struct Mark {
    Number number;
    boost::shared_ptr<afm_emulator::Applied> applied;
    boost::shared_ptr<afm_emulator::Snapshot> snapshot;
    bool is_repeated = false;                             // and others may have come between
    std::uint64_t lost_commands = 0, lost_snapshots = 0;  // between this one and the next

    std::uint32_t epoch() const { return applied ? applied->epoch : snapshot->epoch; }
    const afm_emulator::Applied& in_force() const { return applied ? *applied : snapshot->applied; }
  };
  struct Missing {
    std::string what, after;
    std::uint64_t count;
  };

  void read_marks();
  void check_number(const Mark& before, const afm_emulator::Applied& applied, const Number& number);
  void check_configurations();
  bool is_due(const Mark& mark) const;
  void take(const Mark& mark);
  const afm_emulator::Snapshot* snapshot_behind(const Mark& mark) const;
  void begin_epoch(const Mark& mark, const afm_emulator::Configuration& configuration);
  void begin_at(const Mark& mark);
  void note_beginning(const Mark& mark);
  void keep_what_was_in_force(afm_emulator::Applied& applied) const;
  void take_applied(const afm_emulator::Applied& applied);
  void take_snapshot(const Mark& mark);
  void settle();
  void check_batch();
  bool is_hole() const;
  void check_without_friction();
  bool is_whole_batch(const afm_emulator::Deflection* deflection, const afm_emulator::ImpactArray* impacts, Run& run);
  void advance(const afm_emulator::Friction& recorded);
  void advance_to(const ModelTime& time, std::uint64_t impacts);
  void run_to(const afm_emulator::ModelTime& to, std::uint64_t impacts);
  template <class Message>
  boost::shared_ptr<Message> of_batch(Cursor<Message>& messages);
  template <class Message>
  void check_ends();
  template <class Message>
  void take_next(Cursor<Message>& messages);
  template <class Message>
  void compare(const Message& recorded, Message simulated);
  // `after`: the model time of the first; empty: now
  void lose(const std::string& what, std::uint64_t count, const std::string& after = "");

  const Recording& recording_;
  const Progress progress_;
  const double most_gap_;
  std::vector<Mark> marks_;
  std::size_t next_mark_ = 0;
  std::set<std::pair<std::uint64_t, std::uint32_t>> known_epochs_;  // of the marks: start of the node, and epoch
  std::unique_ptr<Cursor<afm_emulator::Friction>> batches_;
  std::unique_ptr<Cursor<afm_emulator::Deflection>> deflections_;  // none, where the bag holds no such topic
  std::unique_ptr<Cursor<afm_emulator::ImpactArray>> impacts_;     // likewise

  // the run; without one, nothing is compared up to the next snapshot
  std::optional<Run> run_;
  std::uint64_t start_ = 0;              // of the node that it is by
  std::uint64_t unplaced_commands_ = 0;  // lost at a beginning or an end of an epoch, where no number shows it
  node::Parameters in_force_;
  afm_emulator::Configuration configuration_;
  afm_emulator::Applied applied_;
  Batch batch_;
  boost::shared_ptr<afm_emulator::Friction> last_;  // batch compared since something was applied
  bool has_begun_ = false;                          // and no batch was compared since
  bool has_begun_at_repeated_ = false;              // at a latched message that rosbag record repeats
  bool is_doubtful_ = false;                        // a command or a snapshot is lost: a difference is what it did
  bool is_behind_hole_ = false;                     // where a snapshot may be lost: the same

  std::optional<Difference> difference_;
  Extent extent_;
  std::vector<Missing> missing_;
  std::string batches_end_;  // model time up to which there were batches
};

}  // namespace afm::bags
