// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_surface_mesh_h
#define alveolus_remeshing_surface_mesh_h

#include <alveolus/remeshing/smooth_body.h>

namespace alveolus
{
  /**
   * New triangles on the surfaces of a SmoothBody: edges are divided, joined
   * and turned, and nodes moved along their curves and patches, until the edges
   * are about as long as wanted (M. Botsch, L. Kobbelt: A remeshing approach to
   * multiresolution modeling, Symp. Geometry Processing 2004; here on several
   * patches at once, between which curves stay). Corners stay where they are.
   * Deterministic: the same on every process.
   */
  class SurfaceMesh
  {
  public:
    /** No curve. */
    static constexpr unsigned int none = BodySurface::none;

    /** A node on a corner, a curve or a patch. */
    struct Vertex
    {
      /** What it may move on. */
      enum class On
      {
        corner,
        curve,
        patch
      };
      On                on    = On::corner; ///< what it may move on
      unsigned int      index = 0;  ///< of the node, the curve or the patch
      double            u     = 0.; ///< parameter on the curve
      SmoothBody::Place place;      ///< on the patch
      double            size = 0.;  ///< wanted length of edges here [mm]
      /** Places by part; of other parts without meaning [mm]. */
      std::vector<dealii::Point<3>> x;
      std::vector<bool>             is_in; ///< parts in which it has a place
    };

    /** On one patch. */
    struct Triangle
    {
      /** Counterclockwise seen from outside of the patch's first component. */
      std::array<unsigned int, 3> vertices{};
      unsigned int                patch = 0; ///< that it is on
    };

    /** @param body with sizes; must outlive this object */
    explicit SurfaceMesh(const SmoothBody &body);

    /** @param n_rounds of dividing, joining, turning and moving */
    void
    remesh(const unsigned int n_rounds);

    /** Vertex in the middle of an edge, on its curve or patch. */
    Vertex
    middle(const SurfaceEdge &edge) const;

    /** Vertex in the middle of a triangle, on its patch. */
    Vertex
    middle(const Triangle &triangle) const;

    /** Curve of an edge, or none. */
    unsigned int
    curve(const SurfaceEdge &edge) const;

    /** A point of a patch nearest to @p x in its first part. */
    Vertex
    patch_vertex(const unsigned int patch, const dealii::Point<3> &x) const;

    /** Smallest quality of a triangle, 4 sqrt(3) area / sum of squares of its
     * edges: 1 if equilateral. */
    double
    smallest_quality() const;

    const SmoothBody     &body;      ///< gives curves, patches and wanted edges
    std::vector<Vertex>   vertices;  ///< of all patches
    std::vector<Triangle> triangles; ///< of all patches

  private:
    Vertex
    curve_vertex(const unsigned int curve, const double u) const;
    /** Parameter of a vertex on a curve, nearest to @p u at a loop's start. */
    double
    parameter(const Vertex      &vertex,
              const unsigned int curve,
              const double       u) const;
    double
    middle_of_curve(const unsigned int curve,
                    const Vertex      &a,
                    const Vertex      &b,
                    const bool         by_size,
                    const Vertex      *at = nullptr) const;

    std::vector<unsigned int>
    triangles_at(const SurfaceEdge &edge) const;
    /** Length over wanted length. */
    double
    relative_length(const SurfaceEdge &edge) const;
    double
    length(const unsigned int a,
           const unsigned int b,
           const unsigned int p) const;
    dealii::Tensor<1, 3>
    area(const Triangle &triangle, const unsigned int part) const;
    double
    quality(const Triangle &triangle) const;
    /** Whether triangles face the same way as @p reference in all parts. */
    bool
    faces_as(const Triangle                          &triangle,
             const std::vector<dealii::Tensor<1, 3>> &reference) const;
    std::vector<dealii::Tensor<1, 3>>
    areas(const Triangle &triangle) const;

    unsigned int
    divide_long_edges();
    unsigned int
    join_short_edges();
    bool
    join(const unsigned int a, const unsigned int b);
    unsigned int
    turn_edges();
    void
    move_vertices();
    bool
    try_place(const unsigned int v, Vertex place);

    void
    remove_triangle(const unsigned int t);
    void
    add_triangle(const Triangle &triangle);
    void
    tidy_up();
    std::vector<SurfaceEdge>
    all_edges() const;

    std::map<SurfaceEdge, unsigned int>    curve_of;
    std::vector<unsigned int>              n_curve_edges;
    std::vector<std::vector<unsigned int>> around; ///< triangles of vertices
    std::vector<bool>                      alive;  ///< triangles
  };
} // namespace alveolus

#endif
