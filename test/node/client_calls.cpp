// Calls the client as it reads from its input, a call a line: control, command_and_wait or mean_force with their
// arguments, "-" for what is not given; tau; epoch; in_force; stale_reads of so many commands; another, which makes
// a second client. Prints an answer for each. client_calls.py is the same in Python.
// usage: client_calls TIMEOUT
#include <afm_emulator/client.h>

#include <cstdlib>
#include <iomanip>
#include <iostream>

using afm_emulator::Client;

namespace {

// Of what is in force, right after a command.
int stale_reads(Client& tip, int commands) {
  int stale = 0;
  for (int i = 0; i < commands; ++i) {
    const double drag_velocity = 1e-6 * (1 + i % 2);
    tip.control(0.0, drag_velocity);
    if (tip.applied().drag_velocity != drag_velocity) ++stale;
  }
  return stale;
}

std::string answer(Client& tip, std::istream& line) {
  std::string name, word;
  line >> name;
  std::vector<Client::Command> given;
  while (line >> word) given.push_back(word == "-" ? Client::Command() : std::strtod(word.c_str(), nullptr));
  given.resize(4);
  std::ostringstream text;
  if (name == "control") {
    const afm_emulator::Control::Response r = tip.control(*given[0], given[1], given[2]);
    text << r.samples << ' ' << r.applied << ' ' << r.epoch << ' ' << r.k_f_work << ' ' << std::fixed
         << std::setprecision(9) << static_cast<double>(r.end.tau) + r.end.phase << ' '
         << static_cast<double>(r.begin.tau) + r.begin.phase << ' ' << 1e12 * r.mean_lateral_force;
  } else if (name == "command_and_wait") {
    const afm_emulator::Applied m = tip.command_and_wait(given[0], given[1]);
    text << m.number << ' ' << m.drag_velocity << ' ' << m.rest_height_m;
  } else if (name == "tau") {
    text << tip.tau();
  } else if (name == "epoch") {
    text << tip.configuration().epoch;
  } else if (name == "in_force") {
    text << tip.applied().number;
  } else if (name == "another") {
    static Client second("/afm");
    text << second.applied().number;
  } else if (name == "stale_reads") {
    text << stale_reads(tip, static_cast<int>(*given[0]));
  } else {
    text << tip.mean_force(*given[0], given[1].value_or(0.0), given[2], given[3]);
  }
  return text.str();
}

}  // namespace

int main(int argc, char** argv) try {
  ros::init(argc, argv, "client_calls", ros::init_options::AnonymousName);
  Client tip("/afm", std::atof(argv[1]));
  std::cout << "answer: there" << std::endl;
  for (std::string text; std::getline(std::cin, text);) {
    std::istringstream line(text);
    try {
      text = answer(tip, line);
    } catch (const afm_emulator::EmulatorError& error) {
      text = std::string("EmulatorError: ") + error.what();
    }
    std::cout << "answer: " << text << std::endl;
  }
} catch (const afm_emulator::Shutdown&) {
  std::cout << "answer: shut down" << std::endl;
}
