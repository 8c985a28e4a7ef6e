// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/process.h>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <sstream>

extern char **environ;

namespace alveolus
{
  namespace
  {
    constexpr std::size_t kept_output = 256 * 1024;

    /** A pipe of which this process reads and the other program writes. */
    struct Pipe
    {
      int read_end  = -1;
      int write_end = -1;

      Pipe()
      {
        std::array<int, 2> ends;
        if (pipe2(ends.data(), O_CLOEXEC) != 0)
          throw RunError("starting another program",
                         std::string("no pipe: ") + std::strerror(errno),
                         "close other programs or raise the file limit");
        read_end  = ends[0];
        write_end = ends[1];
        fcntl(read_end, F_SETFL, O_NONBLOCK);
      }

      Pipe(const Pipe &) = delete;
      Pipe &
      operator=(const Pipe &) = delete;

      ~Pipe()
      {
        close_end(read_end);
        close_end(write_end);
      }

      static void
      close_end(int &end)
      {
        if (end >= 0)
          close(end);
        end = -1;
      }

      /** Append what is there to @p text, keeping its end only. */
      void
      drain(std::string &text)
      {
        std::array<char, 4096> buffer;
        while (read_end >= 0)
          {
            const ssize_t n = read(read_end, buffer.data(), buffer.size());
            if (n > 0)
              {
                text.append(buffer.data(), n);
                if (text.size() > 2 * kept_output)
                  text.erase(0, text.size() - kept_output);
              }
            else if (n < 0 && errno == EINTR)
              continue;
            else
              {
                if (n == 0)
                  close_end(read_end);
                break;
              }
          }
      }
    };

    /** Variables by which MPI starters speak to the processes they start. */
    bool
    belongs_to_mpi_starter(const std::string &variable)
    {
      for (const char *prefix :
           {"OMPI_", "PMIX_", "PMI_", "PRTE_", "HYDRA_", "MPI_LOCAL"})
        if (variable.compare(0, std::strlen(prefix), prefix) == 0)
          return variable.compare(0, 10, "OMPI_ALLOW") != 0;
      return false;
    }

    std::vector<std::string>
    child_environment(const std::map<std::string, std::string> &additions)
    {
      std::vector<std::string> result;
      for (char **entry = environ; *entry != nullptr; ++entry)
        {
          const std::string variable(*entry);
          const std::string name = variable.substr(0, variable.find('='));
          if (!belongs_to_mpi_starter(name) && additions.count(name) == 0)
            result.push_back(variable);
        }
      for (const auto &addition : additions)
        result.push_back(addition.first + "=" + addition.second);
      return result;
    }

    std::vector<char *>
    pointers(std::vector<std::string> &strings)
    {
      std::vector<char *> result;
      for (std::string &s : strings)
        result.push_back(s.data());
      result.push_back(nullptr);
      return result;
    }
  } // namespace



  std::string
  ProcessResult::summary() const
  {
    std::ostringstream text;
    if (!started)
      text << "could not be started (" << start_error << ")";
    else if (timed_out)
      text << "did not end within its time limit and was stopped after "
           << seconds << " s";
    else if (signal != 0)
      text << "crashed by signal " << signal << " (" << strsignal(signal)
           << ")";
    else
      text << "ended with exit code " << exit_code;
    return text.str();
  }



  std::string
  ProcessResult::last_words(const unsigned int n_lines) const
  {
    std::string text = errors.find_first_not_of(" \n\r\t") == std::string::npos
                         ? output
                         : errors;
    while (!text.empty() &&
           std::isspace(static_cast<unsigned char>(text.back())))
      text.pop_back();
    std::size_t begin = text.size();
    for (unsigned int n = 0; n < n_lines && begin != std::string::npos; ++n)
      begin = begin == 0 ? std::string::npos : text.rfind('\n', begin - 1);
    text = begin == std::string::npos ? text : text.substr(begin + 1);
    constexpr std::size_t longest = 2000;
    return text.size() > longest ? text.substr(text.size() - longest) : text;
  }



  ProcessResult
  run_process(const std::vector<std::string>           &arguments,
              const double                              time_limit,
              const std::map<std::string, std::string> &environment)
  {
    using Clock = std::chrono::steady_clock;

    ProcessResult result;
    if (arguments.empty() || arguments[0].empty())
      {
        result.start_error = "no program given";
        return result;
      }

    Pipe                     output, errors;
    std::vector<std::string> argument_copies = arguments;
    std::vector<std::string> environment_copies =
      child_environment(environment);
    const std::vector<char *> argv = pointers(argument_copies);
    const std::vector<char *> envp = pointers(environment_copies);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output.write_end, 1);
    posix_spawn_file_actions_adddup2(&actions, errors.write_end, 2);

    // A process group of its own, so that a time-out reaches its children too,
    // and default signal handling whatever this program (or MPI) has set.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF |
                               POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setpgroup(&attributes, 0);
    sigset_t signals;
    sigfillset(&signals);
    posix_spawnattr_setsigdefault(&attributes, &signals);
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes, &signals);

    pid_t      pid   = -1;
    const auto begin = Clock::now();
    const int  error = posix_spawnp(
      &pid, argv[0], &actions, &attributes, argv.data(), envp.data());
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (error != 0)
      {
        result.start_error = std::strerror(error);
        return result;
      }
    result.started = true;
    Pipe::close_end(output.write_end);
    Pipe::close_end(errors.write_end);

    const auto seconds_so_far = [&begin] {
      return std::chrono::duration<double>(Clock::now() - begin).count();
    };

    // Its end is asked for, not derived from closed pipes: a grandchild may
    // keep them open.
    int   status = 0;
    pid_t ended  = 0;
    while (ended == 0)
      {
        std::array<pollfd, 2> ends{
          {{output.read_end, POLLIN, 0}, {errors.read_end, POLLIN, 0}}};
        poll(ends.data(), ends.size(), 10);
        if (output.read_end < 0 && errors.read_end < 0)
          usleep(2000);
        output.drain(result.output);
        errors.drain(result.errors);
        ended = waitpid(pid, &status, WNOHANG);
        if (ended < 0 && errno == EINTR)
          ended = 0;
        if (ended == 0 && seconds_so_far() > time_limit)
          {
            result.timed_out = true;
            kill(-pid, SIGKILL);
            do
              ended = waitpid(pid, &status, 0);
            while (ended < 0 && errno == EINTR);
          }
      }
    const int wait_error = errno;
    kill(-pid, SIGKILL); // what it may have left running
    output.drain(result.output);
    errors.drain(result.errors);
    result.seconds = seconds_so_far();

    if (ended < 0)
      throw RunError("running '" + arguments[0] + "'",
                     std::string("its end was not reported: ") +
                       std::strerror(wait_error),
                     "");
    if (WIFSIGNALED(status))
      result.signal = WTERMSIG(status);
    else
      result.exit_code = WEXITSTATUS(status);
    return result;
  }
} // namespace alveolus
