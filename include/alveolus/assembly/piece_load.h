// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_piece_load_h
#define alveolus_assembly_piece_load_h

#include <alveolus/assembly/condition.h>
#include <alveolus/base/expressions.h>

#include <memory>

namespace alveolus
{
  /**
   * A load on a named piece of the boundary whose total is given: a force F(t)
   * and a couple M(t) (in 2D per mm of thickness), spread over the piece in its
   * reference shape X = x - u, the place where the material came from, with
   * area A0 and area centroid X_c. Traction per reference area
   *
   *   t_0 = F q_f + M q_m,
   *   q_f = -N / |int N dA|   (direction normal: a pressure, F > 0 presses),
   *         d / A0            (direction d, a unit vector),
   *   q_m = a x (X - X_c),  a = J^{-1} axis,  J = int |r|^2 I - r r^T dA,
   *
   * r = X - X_c: q_m has no resultant and the moment 1 about the axis (in 2D
   * the axis is z, a = 1/int |r|^2 dA, positive anticlockwise).
   *
   * Dead load: t_0 keeps its direction in space. As it knows the material, not
   * the mesh, rezoning and remeshing do not change it. A couple of dead forces
   * turns by phi with its body and has then the moment M cos(phi).
   *
   * Follower load: t_0 dA is carried along with the surface. Its components in
   * the basis of the tangents X_,a of the element face and of the normal N dA
   * stay, and the basis becomes x_,a and n da of the deformed face, so that a
   * pressure stays normal and a couple keeps its moment however the piece
   * turns. Each of the two parts is scaled such that its total (resultant, and
   * moment about the current centroid) keeps the given magnitude while the
   * piece is strained. The load stiffness is exact but for the derivative of
   * that scaling, which couples all nodes of the piece; it vanishes for every
   * rigid motion of the piece.
   *
   * Boundaries whose nodes slide from one piece to another are not foreseen.
   */
  template <int dim>
  class PieceLoad : public Condition<dim>
  {
  public:
    void
    attach(const State<dim> &state, const std::string &where) override;
    void
    begin_step(const State<dim> &state, const Interval &interval) override;
    void
    add_forces(const State<dim>     &state,
               const NodalVector    &increment,
               const AssemblyTarget &target) override;

    /** "applied force [N]" (F) and "applied moment [N mm]" (M), if given. */
    std::vector<Recorded>
    applied(const State<dim> &state) const override;

  protected:
    /** Add the parameters that all such loads have. */
    void
    declare_common(dealii::ParameterHandler &prm);

    /** Force F and couple M at a time; what is not given is zero. */
    double
    force(const double t) const;
    /** Couple M at a time [N mm (per mm)]. */
    double
    moment(const double t) const;

    std::string on;               ///< name of the boundary piece
    bool        follower = false; ///< whether the load turns with the piece
    std::string force_text;       ///< function of t [N (per mm)]; empty: none
    std::string moment_text; ///< function of t [N mm (per mm)]; empty: none
    std::string direction = "normal"; ///< of the force: "normal" or a vector
    /** Of the couple in 3D, a vector. */
    std::string axis_text = "0, 0, 1";
    double      ratio     = 0.; ///< couple per force [mm]

  private:
    /** A quadrature point of a face of the piece; see begin_step(). */
    struct FacePoint
    {
      std::vector<double>                 shapes;    ///< scalar shape functions
      std::vector<dealii::Tensor<1, dim>> gradients; ///< on the unit cell
      double                              weight = 0.;
      dealii::Point<dim>                  X;
      dealii::Tensor<1, dim>              N; ///< outward normal times dA/weight
      /** Densities q_f, q_m times dA/weight. */
      dealii::Tensor<1, dim> q_force, q_moment;
      /** Their components along the tangents and, last, the normal. */
      dealii::Tensor<1, dim> c_force, c_moment;
    };
    struct LoadedFace
    {
      std::vector<dealii::types::global_dof_index> dofs;
      unsigned int                                 direction = 0;
      double                                       outward   = 1.;
      std::vector<FacePoint>                       points;
    };
    /** Tangents and outward normal of a face point at nodal positions. */
    struct Surface
    {
      dealii::Point<dim>                      x;
      std::array<dealii::Tensor<1, dim>, dim> basis; ///< the normal is last
    };

    template <class Position>
    Surface
    surface(const LoadedFace &face,
            const FacePoint  &point,
            const Position   &position) const;

    /** What the given components make of the basis. */
    static dealii::Tensor<1, dim>
    combine(const dealii::Tensor<1, dim> &components, const Surface &surface);

    void
    find_faces(const State<dim> &state);
    void
    distribute(const State<dim> &state);
    void
    scale_to_total(const State<dim> &state, const NodalVector &increment);

    std::set<dealii::types::boundary_id>       ids;
    std::unique_ptr<dealii::FunctionParser<1>> force_function, moment_function;
    bool                                       normal = true;
    dealii::Tensor<1, 3>                       vector, axis;
    std::vector<unsigned int> component, node; ///< of each dof of a cell
    std::vector<LoadedFace>   faces;
    NodalVector               positions; ///< x_n
    double                    time         = 0.;
    double                    force_scale  = 1.; ///< of a follower load
    double                    moment_scale = 1.;
  };
} // namespace alveolus

#endif
