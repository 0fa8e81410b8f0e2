// The same work spread over the processes of mpirun: rank 0 keeps the board and the files, the others ask it for tasks.
// Without MPI in the build, or without mpirun, there is one rank and nothing here does anything.
#pragma once

#include <memory>

#include "task_board.h"

namespace afm {

class Ranks {
 public:
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }

  bool agree(bool go) const;                  // rank 0's answer, everywhere
  [[noreturn]] void abandon(int code) const;  // ends every rank at once, without waiting for what it is doing

  // Rank 0, often and until asking() is 0: answers what the threads of the other ranks ask.
  void serve(TaskBoard& board);
  void expect(int threads_each) { asking_ = (size_ - 1) * threads_each; }
  int asking() const { return asking_; }  // threads elsewhere that still want work

  // The other ranks: rank 0's board from afar, for all threads of this process.
  std::unique_ptr<WorkSource> remote_board();

 private:
  int rank_ = 0, size_ = 1;
  int asking_ = 0;
};

}  // namespace afm
