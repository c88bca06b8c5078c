// SPDX-License-Identifier: GPL-3.0-or-later
#include "calls.hpp"

#include <chrono>

namespace {

// Python handles signals, such as that of Ctrl-C, only between its own instructions, and a running verb executes none.
void require_no_signal() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

bool is_main_thread() {
  const py::module_ threading = py::module_::import("threading");
  return threading.attr("get_ident")().equal(threading.attr("main_thread")().attr("ident"));
}

// Without a callback progress only checks for signals, all of which go to the main thread.
lsgp::Progress watch_for_signals() {
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds between_looks(50);
  if (!is_main_thread()) return {};
  return [next = Clock::now() + between_looks](double) mutable {
    if (Clock::now() < next) return true;
    const py::gil_scoped_acquire acquire;
    require_no_signal();
    next = Clock::now() + between_looks;
    return true;
  };
}

// Whether a callback's answer is False, also as a bool of numpy; nothing else stops the work.
bool is_false(const py::object& answer) {
  py::detail::make_caster<bool> given;
  return given.load(answer, /*convert=*/false) && !py::detail::cast_op<bool>(given);
}

}  // namespace

lsgp::Progress to_progress(const ProgressCallback& callback) {
  if (!callback) return watch_for_signals();
  return [&callback](double done) {
    const py::gil_scoped_acquire acquire;
    require_no_signal();
    return !is_false((*callback)(done));
  };
}
