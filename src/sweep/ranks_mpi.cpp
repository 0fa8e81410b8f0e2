#define OMPI_SKIP_MPICXX 1  // the C++ bindings of old are not wanted
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "packed.h"
#include "ranks.h"

namespace afm {
namespace {

enum Tag : int { kAsk = 1, kTask = 2, kDone = 3 };

using DoneMessage = std::array<double, 1 + kPackedNumbers>;
using TaskMessage = std::array<double, 3 + kPackedState>;  // first, end (0: no more), carried, start

constexpr std::chrono::microseconds kPause(200);  // MPI's own waiting would burn a core

TaskMessage to_message(const SweepTask& task) {
  TaskMessage message{static_cast<double>(task.first), static_cast<double>(task.end), task.carried ? 1.0 : 0.0};
  const PackedState start = pack(task.start);
  std::copy(start.begin(), start.end(), message.begin() + 3);
  return message;
}

SweepTask to_task(const TaskMessage& message) {
  PackedState start;
  std::copy(message.begin() + 3, message.end(), start.begin());
  return {static_cast<std::size_t>(message[0]), static_cast<std::size_t>(message[1]), message[2] != 0.0, unpack(start)};
}

DoneMessage to_message(const SweepDone& done) {
  DoneMessage message{static_cast<double>(done.position)};
  const PackedResult result = pack(done.result);
  std::copy(result.begin(), result.end(), message.begin() + 1);
  return message;
}

SweepDone to_done(const DoneMessage& message) {
  PackedResult result;
  std::copy(message.begin() + 1, message.end(), result.begin());
  return {static_cast<std::size_t>(message[0]), unpack(result)};
}

template <class Message>
void send(const Message& message, int to, Tag tag) {
  MPI_Send(message.data(), static_cast<int>(message.size()), MPI_DOUBLE, to, tag, MPI_COMM_WORLD);
}

template <class Message>
Message receive(int from, Tag tag) {
  Message message;
  MPI_Recv(message.data(), static_cast<int>(message.size()), MPI_DOUBLE, from, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return message;
}

bool waiting(int from, int tag, MPI_Status& status) {
  int flag = 0;
  MPI_Iprobe(from, tag, MPI_COMM_WORLD, &flag, &status);
  return flag != 0;
}

// MPI is entered by one thread at a time; an answer takes rank 0 a few milliseconds.
class RemoteBoard : public WorkSource {
 public:
  std::optional<SweepTask> take() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    send(std::array<double, 1>{}, 0, kAsk);
    MPI_Status status;
    while (!waiting(0, kTask, status)) std::this_thread::sleep_for(kPause);
    const SweepTask task = to_task(receive<TaskMessage>(0, kTask));
    return task.end == 0 ? std::nullopt : std::optional<SweepTask>(task);
  }

  void deliver(const SweepDone& done) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    send(to_message(done), 0, kDone);
  }

 private:
  std::mutex mutex_;
};

bool under_mpirun() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK", "PMI_RANK"}) {
    if (std::getenv(name) != nullptr) return true;
  }
  return false;
}

}  // namespace

Ranks::Ranks() {
  if (!under_mpirun()) return;
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  if (provided < MPI_THREAD_SERIALIZED && size_ > 1) throw std::runtime_error("this MPI cannot be used from threads");
}

Ranks::~Ranks() {
  int begun = 0;
  MPI_Initialized(&begun);
  if (begun != 0) MPI_Finalize();
}

bool Ranks::agree(bool go) const {
  int answer = go ? 1 : 0;
  if (size_ > 1) MPI_Bcast(&answer, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return answer != 0;
}

void Ranks::abandon(int code) const {
  if (size_ > 1) MPI_Abort(MPI_COMM_WORLD, code);
  std::_Exit(code);
}

void Ranks::serve(TaskBoard& board) {
  MPI_Status status;
  while (size_ > 1 && waiting(MPI_ANY_SOURCE, MPI_ANY_TAG, status)) {
    if (status.MPI_TAG == kDone) {
      board.deliver(to_done(receive<DoneMessage>(status.MPI_SOURCE, kDone)));
      continue;
    }
    receive<std::array<double, 1>>(status.MPI_SOURCE, kAsk);
    const std::optional<SweepTask> task = board.take();
    if (!task) --asking_;
    send(to_message(task.value_or(SweepTask{})), status.MPI_SOURCE, kTask);
  }
}

std::unique_ptr<WorkSource> Ranks::remote_board() { return std::make_unique<RemoteBoard>(); }

}  // namespace afm
