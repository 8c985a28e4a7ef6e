// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_state_portable_fields_h
#define alveolus_state_portable_fields_h

#include <alveolus/base/block_file.h>
#include <alveolus/mesh/configuration.h>
#include <alveolus/state/face_history.h>
#include <alveolus/state/history_store.h>

#include <cstdint>
#include <string>
#include <vector>

namespace alveolus
{
  /**
   * Puts distributed data into blocks and gets them back, in a numbering that
   * does not depend on the number of processes: cells in the order of their
   * CellId, nodal values in the order in which a walk through these cells meets
   * them first. All functions are collective. BlockFile are filled on the first
   * process only; they are read from blocks that every process has.
   *
   * Values come back to the last bit. Ghosts are those of their owners.
   */
  template <int dim>
  class PortableFields
  {
  public:
    /** Find the numbering; valid for as long as the mesh of @p configuration */
    explicit PortableFields(const Configuration<dim> &configuration);

    /** A nodal vector of the configuration. */
    void
    save(const NodalVector &v,
         const std::string &name,
         BlockFile         &blocks) const;

    /** @throws InputError if the block does not fit this mesh */
    void
    load(const BlockFile   &blocks,
         const std::string &name,
         NodalVector       &v) const;

    /**
     * Numbers of the owned cells; those of active cell c are values[begin[c]],
     * ..., values[begin[c+1]-1].
     */
    void
    save(const std::vector<double>      &values,
         const std::vector<std::size_t> &begin,
         const std::string              &name,
         BlockFile                      &blocks) const;

    /** Only numbers of owned cells are set. @throws InputError */
    void
    load(const BlockFile                &blocks,
         const std::string              &name,
         const std::vector<std::size_t> &begin,
         std::vector<double>            &values) const;

    /** Old records of all cells; the trial records become the same. */
    void
    save(const HistoryStore<dim> &history,
         const std::string       &name,
         BlockFile               &blocks) const;
    /**
     * The same back, on any number of processes. @throws InputError if they do
     * not fit
     */
    void
    load(const BlockFile   &blocks,
         const std::string &name,
         HistoryStore<dim> &history) const;

    /** Old records of a boundary; the trial records become the same. */
    void
    save(const FaceHistory<dim> &history,
         const std::string      &name,
         BlockFile              &blocks) const;
    /** The same back. @throws InputError if they do not fit */
    void
    load(const BlockFile   &blocks,
         const std::string &name,
         FaceHistory<dim>  &history) const;

    const Configuration<dim> &configuration; ///< that the history belongs to

  private:
    std::vector<std::size_t>
    begin_of_faces(const FaceHistory<dim> &history) const;

    MPI_Comm                   communicator;
    std::vector<unsigned int>  owned_cells; ///< active indices
    std::vector<std::uint64_t> cell_places; ///< of the owned cells
    std::vector<std::uint64_t> node_places; ///< of the owned nodal values
    std::uint64_t              n_cells = 0, n_nodal_values = 0; ///< global
    // On the first process: places of all, in the order they are gathered.
    std::vector<std::uint64_t> all_cell_places, all_node_places;
  };

  /**
   * The @p values of all processes one after the other, on the first process
   * (collective); of any size.
   */
  template <class Number>
  std::vector<Number>
  gather_on_first(const std::vector<Number> &values,
                  const MPI_Comm            &communicator);
} // namespace alveolus

#endif
