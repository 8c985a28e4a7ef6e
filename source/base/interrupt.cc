// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/interrupt.h>

#include <csignal>

namespace alveolus
{
  namespace Interrupt
  {
    namespace
    {
      volatile std::sig_atomic_t noted = 0;

      /** Reset to the default by SA_RESETHAND for the second signal. */
      extern "C" void
      note_signal(const int signal)
      {
        if (noted != 0)
          { // another one of the four: as the second of the same
            std::signal(signal, SIG_DFL);
            std::raise(signal);
          }
        noted = signal;
      }
    } // namespace



    void
    install()
    {
      noted = 0;
      for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1})
        {
          struct sigaction present;
          if (sigaction(signal, nullptr, &present) != 0 ||
              present.sa_handler == SIG_IGN)
            continue;
          struct sigaction action = {};
          action.sa_handler       = note_signal;
          // System calls go on, so that no output is cut short by a signal.
          action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
          sigemptyset(&action.sa_mask);
          sigaction(signal, &action, nullptr);
        }
      std::signal(SIGXFSZ, SIG_IGN);
    }



    int
    signal()
    {
      return noted;
    }



    std::string
    name(const int signal)
    {
      switch (signal)
        {
          case SIGINT:
            return "SIGINT";
          case SIGTERM:
            return "SIGTERM";
          case SIGHUP:
            return "SIGHUP";
          case SIGUSR1:
            return "SIGUSR1";
          default:
            return "signal " + std::to_string(signal);
        }
    }
  } // namespace Interrupt
} // namespace alveolus
