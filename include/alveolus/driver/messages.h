// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_driver_messages_h
#define alveolus_driver_messages_h

#include <alveolus/base/errors.h>

#include <deal.II/base/mpi.h>

#include <iomanip>
#include <sstream>
#include <string>

namespace alveolus
{
  /** A number for a message. */
  inline std::string
  number(const double value, const int digits = 6)
  {
    std::ostringstream text;
    text << std::setprecision(digits) << value;
    return text.str();
  }

  /**
   * What may help a run that no step is short enough for, by the cause of the
   * last rejection (Verdict::cause).
   */
  std::string
  advice_for(const std::string &cause);

  /**
   * Do on the first process what only it does (files); if that fails, all
   * processes throw the same error instead of waiting for each other.
   */
  template <class Error, typename Function>
  void
  on_first_process(const MPI_Comm &communicator, const Function &action)
  {
    std::string problem;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      try
        {
          action();
        }
      catch (const Error &error)
        {
          problem = error.what();
        }
    problem = dealii::Utilities::MPI::broadcast(communicator, problem);
    if (!problem.empty())
      throw Error("output", problem, "");
  }
} // namespace alveolus

#endif
