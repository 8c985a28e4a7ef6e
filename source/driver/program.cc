// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/driver/program.h>
#include <alveolus/driver/simulation.h>
#include <alveolus/io/checkpoint.h>
#include <alveolus/scene/settings.h>

#include <filesystem>
#include <iostream>
#include <new>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** The output folder that a checkpoint lies in. */
    std::string
    folder_of(const std::string &checkpoint)
    {
      const auto folder =
        std::filesystem::path(checkpoint).parent_path().parent_path().string();
      return folder.empty() ? "." : folder;
    }



    template <int dim>
    int
    simulate(const ParameterText              &text,
             const ProgramOptions             &options,
             const MPI_Comm                   &communicator,
             std::shared_ptr<const BlockFile> &resumed)
    {
      Log        log(Utilities::MPI::this_mpi_process(communicator) == 0,
              options.quiet);
      const auto scene = std::make_shared<Scene<dim>>(text);
      scene->mesh_source->allow_scripts(options.allow_scripts);
      if (!options.output.empty())
        scene->output_directory = options.output;
      else if (resumed)
        scene->output_directory = folder_of(resumed->source);
      std::vector<std::string> changes;
      if (resumed)
        {
          std::ostringstream resolved;
          scene->write_resolved(resolved);
          changes = check_settings(*resumed, resolved.str(), options.accept);
        }
      // It lets go of the checkpoint when it has begun.
      Simulation<dim> simulation(scene, communicator, log, std::move(resumed));
      for (const auto &change : changes)
        log.say("changed: " + change);
      if (options.validate)
        {
          simulation.describe();
          simulation.describe_names();
          return 0;
        }
      return simulation.run() ? 0 : 1;
    }



    int
    run_or_throw(const ProgramOptions &options, const MPI_Comm &communicator)
    {
      const bool speaks = Utilities::MPI::this_mpi_process(communicator) == 0;
      if (options.print_parameters && options.scene.empty())
        {
          if (speaks)
            write_reference(std::cout);
          return 0;
        }
      std::shared_ptr<const BlockFile> resumed;
      if (!options.resume.empty())
        resumed = std::make_shared<const BlockFile>(
          read_checkpoint(options.resume, communicator));
      if (options.scene.empty() && !resumed)
        throw InputError("usage",
                         "no parameter file given",
                         "write alveolus SCENE.prm, or see alveolus --help");
      const ParameterText text =
        options.scene.empty()
          ? saved_settings(*resumed, options.sets)
          : ParameterText::read(options.scene, options.sets);
      const bool three = text.value("Dimension", "2") == "3";
      if (options.print_parameters)
        {
          if (speaks && three)
            Scene<3>(text).write_resolved(std::cout);
          else if (speaks)
            Scene<2>(text).write_resolved(std::cout);
          return 0;
        }
      return three ? simulate<3>(text, options, communicator, resumed)
                   : simulate<2>(text, options, communicator, resumed);
    }
  } // namespace



  int
  run_program(const ProgramOptions &options,
              const MPI_Comm       &communicator,
              std::ostream         &errors)
  {
    const bool speaks = Utilities::MPI::this_mpi_process(communicator) == 0;
    const auto say    = [&](const std::string &message) {
      if (speaks)
        errors << "alveolus: " << message << std::endl;
    };
    try
      {
        return run_or_throw(options, communicator);
      }
    catch (const InputError &error)
      {
        say(error.what());
        return 2;
      }
    catch (const ExceptionBase &error)
      {
        std::ostringstream message;
        error.print_info(message);
        say("internal error: " + message.str());
        return 1;
      }
    catch (const std::bad_alloc &)
      {
        say("out of memory: use a coarser mesh, or a machine with more memory");
        return 1;
      }
    catch (const std::exception &error)
      {
        say(error.what());
        return 1;
      }
  }
} // namespace alveolus
