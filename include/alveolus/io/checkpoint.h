// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_io_checkpoint_h
#define alveolus_io_checkpoint_h

#include <alveolus/base/block_file.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <string>

namespace alveolus
{
  /**
   * The checkpoints of a run: files `checkpoint/NUMBER.alv` in its output
   * folder, numbered upwards, of which the last two are kept. A file is written
   * as a whole or not at all (WholeFile), and the older ones are removed only
   * afterwards, so that there is a valid one at every moment.
   */
  class CheckpointFolder
  {
  public:
    struct Parameters
    {
      bool         write         = true; ///< whether there are any
      double       wall_interval = 60.;  ///< of wall time between two [s]
      unsigned int step_interval = 0;    ///< steps between two; 0: by time only

      /**
       * Add the parameters, bound to the members, to the current subsection.
       */
      void
      declare(dealii::ParameterHandler &prm);
    };

    /** @param directory output folder of the run */
    explicit CheckpointFolder(const std::string &directory);

    /**
     * Remove the checkpoints of an earlier run from the folder: they do not
     * belong to the results that replace those of that run.
     */
    void
    clear();

    /** The run goes on from this file, which is kept. */
    void
    go_on_from(const std::string &file);

    /**
     * Write the next one, then remove all but it and the last one before.
     * @return its name. @throws RunError if it cannot be written
     */
    std::string
    write(const BlockFile &blocks);

    /**
     * What to resume: @p name itself if it is a file, else the newest
     * checkpoint of the output folder of that name.
     * @throws InputError if there is none
     */
    static std::string
    find(const std::string &name);

  private:
    std::string  folder;
    std::string  last; ///< known to be valid
    unsigned int last_number = 0;
  };

  /**
   * Read a checkpoint: the first process reads and checks it, all get it
   * (collective).
   * @param name a file, or an output folder, of which the newest is read
   * @throws InputError that names file and block if it is damaged, and the
   *         older checkpoint if that is whole
   */
  BlockFile
  read_checkpoint(const std::string &name, const MPI_Comm &communicator);
} // namespace alveolus

#endif
