// How the process ends: in our own order, not roscpp's, and also where the master hangs.
#pragma once

namespace afm::node {

// SIGINT, SIGTERM, and SIGHUP where it is not ignored, ask the process to end. Call it before any thread begins. Until
// now_running() is called, such a signal also ends the wait for a master: the process leaves by itself, within 2 s.
void await_signals();
void now_running();
bool is_asked_to_end();

// All is published and recorded; only the master has not been told. If has_left() is not called within 2 s, the process
// ends without it, with exit code 0 and a line to stderr.
void begin_leaving();
void has_left();

}  // namespace afm::node
