// SPDX-License-Identifier: LGPL-2.1-or-later
//
// fuzz [options]: changes valid input files at random and lets the program read
// and check them as `alveolus --validate` does; nothing is solved. Each input
// has to be accepted or refused with exit code 2 and a message. Any other end -
// another code, an exception, a signal, a report of a sanitizer, a time beyond
// the limit - is a failure, whose input is kept.
//
// Input number i of a seed is always the same: `--first i --count 1` repeats
// it. Inputs are read in processes of a few hundred, which are started anew
// after a crash; at their ends LeakSanitizer, if it is built in, looks for
// leaks.
#include "mutations.h"
#include "seeds.h"

#include <alveolus/base/block_file.h>
#include <alveolus/driver/program.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <boost/program_options.hpp>

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __SANITIZE_ADDRESS__
#  include <sanitizer/lsan_interface.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <sstream>

namespace alveolus::fuzz
{
  namespace fs = std::filesystem;

  namespace
  {
    struct Options
    {
      std::uint64_t first = 0, count = 500, seed = 1, batch = 250;
      unsigned int  time_limit = 10; ///< of one input [s of processor time]
      std::string   work = "fuzz-work", kept = "fuzz-failures", only;
      bool          verbose = false;
    };

    /** What the process that reads inputs tells the one that watches it. */
    struct Progress
    {
      std::uint64_t at; ///< number of the input
      std::uint64_t accepted[5], refused[5];
      std::uint64_t unmeshed[5];  ///< gmsh's double had no mesh of this outline
      double        slowest_time; ///< [s of processor time]
      std::uint64_t slowest;      ///< number of that input
      char          problem[4000]; ///< of this input, if it ended by itself
    };

    /** Whether LeakSanitizer, if it is built in, counts what is allocated. */
    void
    leaks_count(const bool yes)
    {
#ifdef __SANITIZE_ADDRESS__
      yes ? __lsan_enable() : __lsan_disable();
#endif
      (void)yes;
    }

    bool
    there_are_leaks()
    {
#ifdef __SANITIZE_ADDRESS__
      return __lsan_do_recoverable_leak_check() != 0;
#else
      return false;
#endif
    }



    /** Start an MPI process, let it do @p action and wait for its end. */
    int
    in_a_process(const std::string               &said,
                 const std::function<void(void)> &action)
    {
      const pid_t pid = fork();
      if (pid == 0)
        {
          const int file =
            open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
          dup2(file, 1);
          dup2(file, 2);
          close(file);
          int         argc        = 1;
          std::string name        = "fuzz";
          char       *arguments[] = {name.data(), nullptr};
          char      **argv        = arguments;
          setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
          int code = 0;
          leaks_count(false); // MPI's own
          {
            dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
            leaks_count(true);
            try
              {
                action();
              }
            catch (const std::exception &error)
              {
                std::cerr << error.what() << std::endl;
                code = 1;
              }
            if (code == 0 && there_are_leaks())
              code = 23;
            leaks_count(false);
          }
          std::cout.flush();
          std::_Exit(code);
        }
      int status = 0;
      while (waitpid(pid, &status, 0) < 0 && errno == EINTR)
        {}
      return status;
    }

    std::string
    text_of(const std::string &file)
    {
      std::ifstream      in(file, std::ios::binary);
      std::ostringstream text;
      text << in.rdbuf();
      return text.str();
    }

    void
    save(const std::vector<Seed> &seeds, const std::string &file)
    {
      BlockFile blocks;
      for (std::size_t s = 0; s < seeds.size(); ++s)
        {
          const std::string name = std::to_string(s) + "/";
          blocks.put_integer(name + "kind",
                             static_cast<std::uint64_t>(seeds[s].kind));
          blocks.put(name + "name", seeds[s].name);
          blocks.put(name + "file", seeds[s].file_name);
          blocks.put(name + "content", seeds[s].content);
          blocks.put(name + "scene", seeds[s].scene);
          blocks.put(name + "parameter", seeds[s].parameter);
        }
      std::ofstream out(file, std::ios::binary);
      blocks.write(out);
    }

    std::vector<Seed>
    load(const std::string &file)
    {
      const BlockFile   blocks = BlockFile::parse(text_of(file), file);
      std::vector<Seed> seeds;
      for (std::string name = "0/"; blocks.has(name + "kind");
           name             = std::to_string(seeds.size()) + "/")
        seeds.push_back({static_cast<Kind>(blocks.integer(name + "kind")),
                                     blocks.text(name + "name"),
                                     blocks.text(name + "file"),
                                     blocks.text(name + "content"),
                                     blocks.text(name + "scene"),
                                     blocks.text(name + "parameter")});
      return seeds;
    }

    class Fuzzer
    {
    public:
      explicit Fuzzer(const Options &options)
        : options(options)
        , work(fs::absolute(options.work).string())
        , progress(static_cast<Progress *>(mmap(nullptr,
                                                sizeof(Progress),
                                                PROT_READ | PROT_WRITE,
                                                MAP_SHARED | MAP_ANONYMOUS,
                                                -1,
                                                0)))
      {}

      /** @return whether there was no failure */
      bool
      run()
      {
        const auto begin = std::chrono::steady_clock::now();
        fs::remove_all(work);
        fs::create_directories(work);
        const std::string said   = work + "/said.txt";
        const int         status = in_a_process(said, [&]() {
          save(make_seeds(ALVEOLUS_SOURCE_DIR, work), work + "/seeds");
        });
        if (!fs::exists(work + "/seeds") || status != 0)
          {
            std::cout << text_of(said) << "the seeds cannot be made ("
                      << description(status) << ")\n";
            return false;
          }
        for (Seed &seed : load(work + "/seeds"))
          if (options.only.empty() || name_of(seed.kind) == options.only)
            by_kind[seed.kind].push_back(seed);

        const std::uint64_t end = options.first + options.count;
        for (std::uint64_t i = options.first; i < end;)
          {
            const std::uint64_t batch_end = std::min(end, i + options.batch);
            const int ended = in_a_process(said, [&]() { read(i, batch_end); });
            if (progress->at < batch_end)
              {
                report(progress->at, description(ended));
                i = progress->at + 1;
                continue;
              }
            if (ended != 0)
              {
                ++n_failures;
                std::cout << "inputs " << i << " to " << batch_end - 1
                          << " together: " << description(ended) << "\n"
                          << text_of(said).substr(0, 4000) << std::endl;
              }
            i = batch_end;
          }

        std::cout << "kind         accepted   refused  unmeshed\n";
        std::uint64_t n = 0;
        for (const Kind kind : all_kinds)
          if (by_kind.count(kind) != 0)
            {
              const auto k = static_cast<unsigned int>(kind);
              char       line[80];
              std::snprintf(
                line,
                sizeof(line),
                "%-10s %10llu %9llu %9llu\n",
                name_of(kind).c_str(),
                static_cast<unsigned long long>(progress->accepted[k]),
                static_cast<unsigned long long>(progress->refused[k]),
                static_cast<unsigned long long>(progress->unmeshed[k]));
              std::cout << line;
              n += progress->accepted[k] + progress->refused[k] +
                   progress->unmeshed[k];
            }
        std::cout << "slowest: input " << progress->slowest << ", from "
                  << input(progress->slowest).first->name << ", "
                  << progress->slowest_time << " s of processor time\n";
        std::cout << n << " of " << options.count
                  << " inputs ended as they should, " << n_failures
                  << " failures, seed " << options.seed << ", "
                  << std::chrono::duration<double>(
                       std::chrono::steady_clock::now() - begin)
                       .count()
                  << " s" << std::endl;
        return n_failures == 0 && n == options.count;
      }

    private:
      const Options                     options;
      const std::string                 work;
      Progress                         *progress;
      std::map<Kind, std::vector<Seed>> by_kind;
      unsigned int                      n_failures = 0;

      /** Which seed, and what becomes of it. */
      std::pair<const Seed *, std::string>
      input(const std::uint64_t i) const
      {
        Random random(options.seed * 0x100000001b3ull + i);
        random.number();
        auto kind = by_kind.begin();
        std::advance(kind, i % by_kind.size());
        const auto       &seeds = kind->second;
        const Seed       &seed  = seeds[random.below(seeds.size())];
        const Seed       &other = seeds[random.below(seeds.size())];
        const std::string content =
          kind->first == Kind::checkpoint
            ? mutated_blocks(seed.content, random)
            : mutated_text(seed.content, other.content, random);
        return {&seed, content};
      }

      /** Let the program read the inputs from @p begin to @p end. */
      void
      read(const std::uint64_t begin, const std::uint64_t end) const
      {
        dealii::deal_II_exceptions::suppress_stacktrace_in_exceptions();
        setenv("PATH", (work + "/bin").c_str(), 1);
        for (std::uint64_t i = begin; i < end; ++i)
          {
            progress->at               = i;
            progress->problem[0]       = 0;
            const auto [seed, content] = input(i);
            const std::string folder   = work + "/in/checkpoint";
            fs::create_directories(folder);
            const std::string file = folder + "/" + seed->file_name;
            std::ofstream(file, std::ios::binary) << content;

            ProgramOptions program;
            program.validate = program.quiet = true;
            program.output                   = work + "/out";
            program.sets = {"Mesh/Largest number of cells=5000"};
            if (seed->kind == Kind::checkpoint)
              {
                program.resume = file;
                program.accept = true;
              }
            else if (seed->scene.empty())
              program.scene = file;
            else
              {
                program.scene = seed->scene;
                program.sets.push_back(seed->parameter + "=" + file);
              }
            const std::clock_t before = std::clock();
            std::ostringstream message;
            set_time_limit(options.time_limit);
            const int code = run_program(program, MPI_COMM_WORLD, message);
            set_time_limit(0);
            const double time =
              static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
            if (time > progress->slowest_time)
              {
                progress->slowest_time = time;
                progress->slowest      = i;
              }
            if (options.verbose)
              std::cerr << i << ' ' << seed->name << ": " << code << ", "
                        << time << " s " << message.str() << std::endl;
            const auto k = static_cast<unsigned int>(seed->kind);
            if (code == 0)
              ++progress->accepted[k];
            else if (code == 2 && message.str().size() > 20)
              ++progress->refused[k];
            else if (code == 1 &&
                     message.str().find(": the mesher 'gmsh' ended with exit "
                                        "code 1") != std::string::npos)
              ++progress->unmeshed[k];
            else
              {
                std::snprintf(progress->problem,
                              sizeof(progress->problem),
                              "exit code %d: %s",
                              code,
                              message.str().c_str());
                return;
              }
          }
        progress->at = end;
      }

      /**
       * Processor time of the program and of the system for it. An input that
       * waits for something takes none: sixty times as much of the clock, since
       * the machine may be busy with other work.
       */
      static void
      set_time_limit(const unsigned int seconds)
      {
        itimerval timer{};
        timer.it_value.tv_sec = seconds;
        setitimer(ITIMER_PROF, &timer, nullptr);
        alarm(60 * seconds);
      }

      static std::string
      description(const int status)
      {
        if (!WIFSIGNALED(status))
          return "exit code " + std::to_string(WEXITSTATUS(status));
        const int signal = WTERMSIG(status);
        return signal == SIGPROF || signal == SIGALRM
                 ? "takes too long"
                 : std::string("signal ") + strsignal(signal);
      }

      void
      report(const std::uint64_t i, const std::string &ended)
      {
        ++n_failures;
        const auto [seed, content] = input(i);
        fs::create_directories(options.kept);
        const std::string name =
          options.kept + "/" + std::to_string(i) + "-" + seed->file_name;
        std::ofstream(name, std::ios::binary) << content;
        std::cout << "input " << i << ", from " << seed->name << ", kept as "
                  << name << ": "
                  << (progress->problem[0] != 0 ? progress->problem : ended)
                  << std::endl;
        const std::string said = text_of(work + "/said.txt");
        std::ofstream(name + ".txt") << said;
        const auto at = std::min(said.find("ERROR: AddressSanitizer"),
                                 said.find("runtime error:"));
        if (at != std::string::npos)
          std::cout << said.substr(at > 200 ? at - 200 : 0, 3000) << std::endl;
      }
    };
  } // namespace
} // namespace alveolus::fuzz



int
main(int argc, char **argv)
{
  namespace po = boost::program_options;
  alveolus::fuzz::Options options;
  po::options_description all("fuzz [options]");
  all.add_options()("help", "this text")("count",
                                         po::value(&options.count),
                                         "how many inputs")(
    "first", po::value(&options.first), "number of the first one")(
    "seed", po::value(&options.seed), "of the random numbers")(
    "batch", po::value(&options.batch), "inputs for each process")(
    "only",
    po::value(&options.only),
    "parameters, mesh, outline, table or checkpoint")(
    "time-limit",
    po::value(&options.time_limit),
    "for one input [s of processor time]")("work",
                                           po::value(&options.work),
                                           "folder for files, emptied first")(
    "keep", po::value(&options.kept), "folder for inputs that failed")(
    "verbose", po::bool_switch(&options.verbose), "every outcome to said.txt");
  po::variables_map given;
  try
    {
      po::store(po::parse_command_line(argc, argv, all), given);
      po::notify(given);
    }
  catch (const po::error &error)
    {
      std::cerr << error.what() << "\n" << all;
      return 2;
    }
  if (given.count("help") > 0)
    {
      std::cout << all;
      return 0;
    }
  return alveolus::fuzz::Fuzzer(options).run() ? 0 : 1;
}
