// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_interrupt_h
#define alveolus_base_interrupt_h

#include <string>

namespace alveolus
{
  /**
   * Signals that ask a run to stop: SIGINT, SIGTERM, SIGHUP, and SIGUSR1, which
   * MPI starters hand on to the processes they started. The first one is only
   * noted; the run finishes its step, saves everything and ends. The second one
   * ends the process at once. Signals that are ignored (nohup) stay ignored.
   */
  namespace Interrupt
  {
    /**
     * Note signals from now on, forget earlier ones; and let writing beyond a
     * limit of file sizes fail like writing to a full disk instead of ending
     * the process.
     */
    void
    install();

    /** The signal that came, or 0 (this process only). */
    int
    signal();

    /** E.g. "SIGTERM". */
    std::string
    name(const int signal);
  } // namespace Interrupt
} // namespace alveolus

#endif
