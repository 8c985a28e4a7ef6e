// SPDX-License-Identifier: LGPL-2.1-or-later
// The solid body rotation test of R. J. LeVeque, SIAM J. Numer. Anal. 33 (1996)
// 627-665: a slotted disc (height 1), a cone (height 1) and a smooth hump
// (height 1/2). Here the field stays and the mesh of a disc of radius 1/2 turns
// once through it. Prints the L1 error, the kept maxima and the drift of the
// content of both orders, by swept transfer and by overlap.
//
// With ALVEOLUS_ROTATION_LEVELS=4 in the environment the mesh has sub-cells of
// 1/125, as in the literature (default 3: 1/62); with ALVEOLUS_ROTATION_OUTPUT
// a folder, lines "x y value" of the last state are written there.
#include <alveolus/state/reproducible_sum.h>
#include <alveolus/transfer/overlap_transfer.h>
#include <alveolus/transfer/swept_transfer.h>

#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <sstream>

using namespace dealii;
using namespace alveolus;

namespace
{
  const Point<2>   disc(0.5, 0.75), cone(0.5, 0.25), hump(0.25, 0.5);
  constexpr double radius = 0.15;

  double
  field(const Point<2> &p)
  {
    if (p.distance(disc) < radius)
      return std::abs(p[0] - 0.5) >= 0.025 || p[1] >= 0.85 ? 1. : 0.;
    if (p.distance(cone) < radius)
      return 1. - p.distance(cone) / radius;
    if (p.distance(hump) < radius)
      return 0.25 * (1. + std::cos(numbers::PI * p.distance(hump) / radius));
    return 0.;
  }

  unsigned int
  levels()
  {
    const char *text = std::getenv("ALVEOLUS_ROTATION_LEVELS");
    return text == nullptr ? 3 : std::atoi(text);
  }

  struct Result
  {
    double       error = 0., least = 1e9, drift = 0.;
    double       disc = 0., cone = 0., hump = 0.; ///< kept maxima
    unsigned int n_steps = 0, n_limited = 0;
  };

  /** A number for the report of the test, from which scripts/verify takes it.
   */
  void
  record(const std::string &key, const double value)
  {
    std::ostringstream text;
    text << std::setprecision(16) << value;
    testing::Test::RecordProperty(key, text.str());
  }

  class Rotation
  {
  public:
    explicit Rotation(const std::string &scheme)
      : scheme(scheme)
    {
      mesh.triangulation =
        std::make_unique<parallel::distributed::Triangulation<2>>(
          MPI_COMM_WORLD);
      GridGenerator::hyper_ball_balanced(*mesh.triangulation,
                                         Point<2>(0.5, 0.5),
                                         0.5);
      mesh.triangulation->refine_global(levels());
      configuration = std::make_unique<Configuration<2>>(mesh, 1);
      store         = make_store();
      transfer      = std::make_unique<SweptTransfer<2>>(
        *configuration,
        *store,
        Registry<TransferScheme<2>>::create(scheme, "Scheme"));
      configuration->set_positions(turned(0.));

      // Means of the field, by 8 x 8 points in each sub-cell.
      for_each([](const std::vector<Point<2>> &points, double, double *record) {
        double sum = 0.;
        for (const auto &p : points)
          sum += field(p);
        *record = sum / points.size();
      });
    }

    Result
    swept()
    {
      // Courant number about 1/2 at the rim.
      const unsigned int n_steps = 39 << levels();
      Result             result;
      for (unsigned int step = 1; step <= n_steps; ++step)
        {
          const NodalVector    x = turned(1. * step / n_steps);
          const TransferReport report =
            transfer->transfer(*store, configuration->positions(), x);
          configuration->set_positions(x);
          note(result,
               report.n_limited,
               report.content_after - report.through_boundary,
               report.content_before);
        }
      return finish(result, "swept");
    }

    /**
     * Each state on a mesh turned by 11.25 degrees, as if it were another one:
     * a multiple of the angle of a side, so that the boundaries coincide.
     */
    Result
    overlap()
    {
      const unsigned int n_steps = 32;
      Result             result;
      for (unsigned int step = 1; step <= n_steps; ++step)
        {
          const OverlapTransfer<2> remap(*configuration, *store, scheme);
          auto                     next = make_store();
          configuration->set_positions(turned(1. * step / n_steps));
          const OverlapReport report = remap.transfer(*configuration, *next);
          store->old_values          = next->old_values;
          note(result,
               report.n_limited,
               report.content_after(),
               report.content_before());
        }
      return finish(result, "overlap");
    }

  private:
    std::unique_ptr<HistoryStore<2>>
    make_store() const
    {
      HistoryField density;
      density.name  = "density";
      density.lower = 0.;
      density.upper = 1.;
      return std::make_unique<HistoryStore<2>>(
        *mesh.triangulation,
        std::map<types::material_id, unsigned int>{{0, 0}},
        std::vector<HistoryLayout>{HistoryLayout({density}, 2)},
        4);
    }

    /** Positions after a part of the turn. */
    NodalVector
    turned(const double part) const
    {
      const double       angle = 2. * numbers::PI * part;
      const double       c = std::cos(angle), s = std::sin(angle);
      const CellNodes<2> nodes(*configuration);
      NodalVector        x = configuration->make_vector();
      x.zero_out_ghost_values();
      CellNodes<2>::NodeTensors p;
      for (const unsigned int cell : transfer->subcells().owned_cells())
        {
          nodes.gather(configuration->initial_positions(), cell, p);
          for (unsigned int i = 0; i < 4; ++i)
            {
              const unsigned int *entry = nodes.local_entries(cell, i);
              const double        u = p[i][0] - 0.5, v = p[i][1] - 0.5;
              if (entry[0] < x.locally_owned_size())
                {
                  x.local_element(entry[0]) = 0.5 + c * u - s * v;
                  x.local_element(entry[1]) = 0.5 + s * u + c * v;
                }
            }
        }
      x.update_ghost_values();
      return x;
    }

    /** Go over owned sub-cells: points in it, volume, record. */
    void
    for_each(
      const std::function<void(const std::vector<Point<2>> &, double, double *)>
        &f) const
    {
      constexpr unsigned int n = 8;
      std::vector<double>    volume;
      const NodalVector      x = configuration->positions();
      transfer->subcells().volumes(x, volume);
      const CellNodes<2>       &nodes = transfer->subcells().nodes;
      CellNodes<2>::NodeTensors position;
      CellNodes<2>::NodeNumbers shape;
      std::vector<Point<2>>     points(n * n);
      for (const unsigned int c : transfer->subcells().owned_cells())
        {
          nodes.gather(x, c, position);
          for (unsigned int q = 0; q < 4; ++q)
            {
              for (unsigned int i = 0; i < n * n; ++i)
                {
                  nodes.shape_values(
                    Point<2>(0.5 * (q % 2) + 0.5 * (i % n + 0.5) / n,
                             0.5 * (q / 2) + 0.5 * (i / n + 0.5) / n),
                    shape);
                  points[i] = Point<2>();
                  for (unsigned int k = 0; k < 4; ++k)
                    points[i] += shape[k] * position[k];
                }
              f(points, volume[4 * c + q], store->old_record(c, q));
            }
        }
    }

    void
    note(Result            &result,
         const unsigned int n_limited,
         const double       after,
         const double       before) const
    {
      ++result.n_steps;
      result.n_limited += n_limited;
      result.drift = std::max(result.drift, std::abs(after / before - 1.));
    }

    Result
    finish(Result result, const std::string &way) const
    {
      std::vector<double> error, whole;
      std::ofstream       file;
      if (const char *folder = std::getenv("ALVEOLUS_ROTATION_OUTPUT"))
        file.open(std::string(folder) + "/rotation-" + way + "-" +
                  (scheme == "Godunov" ? "1" : "2") + ".dat");
      for_each([&](const std::vector<Point<2>> &points,
                   const double                 volume,
                   const double                *record) {
        double   exact = 0.;
        Point<2> centre;
        for (const auto &p : points)
          {
            exact += field(p) / points.size();
            centre += p / static_cast<double>(points.size());
          }
        error.push_back(volume * std::abs(*record - exact));
        whole.push_back(volume * exact);
        result.least    = std::min(result.least, *record);
        const auto keep = [&](const Point<2> &body, double &largest) {
          if (centre.distance(body) < radius)
            largest = std::max(largest, *record);
        };
        keep(disc, result.disc);
        keep(cone, result.cone);
        keep(hump, result.hump);
        if (file)
          file << centre[0] << ' ' << centre[1] << ' ' << *record << '\n';
      });
      result.error = reproducible_sum(error, MPI_COMM_WORLD) /
                     reproducible_sum(whole, MPI_COMM_WORLD);
      std::cout << way << ' ' << scheme << ", " << result.n_steps
                << " transfers: L1 error " << result.error
                << " of the content, maxima " << result.disc << ' '
                << result.cone << ' ' << result.hump << ", minimum "
                << result.least << ", largest drift of content " << result.drift
                << std::endl;
      const std::string key =
        way + " " + (scheme == "Godunov" ? "1" : "2") + " ";
      record(key + "error", result.error);
      record(key + "disc", result.disc);
      record(key + "cone", result.cone);
      record(key + "hump", result.hump);
      record(key + "minimum", result.least);
      record(key + "drift", result.drift);
      return result;
    }

    std::string                       scheme;
    Mesh<2>                           mesh;
    std::unique_ptr<Configuration<2>> configuration;
    std::unique_ptr<HistoryStore<2>>  store;
    std::unique_ptr<SweptTransfer<2>> transfer;
  };

  /** What must hold for any number of levels. */
  void
  compare(const Result &first, const Result &second)
  {
    for (const Result &r : {first, second})
      {
        EXPECT_EQ(r.n_limited, 0u);
        EXPECT_GE(r.least, -1e-14);
        EXPECT_LE(r.disc, 1. + 1e-14);
        EXPECT_LE(r.cone, 1. + 1e-14);
        EXPECT_LE(r.hump, 0.5 + 1e-14);
        EXPECT_LE(r.drift, 1e-13);
      }
    EXPECT_LT(second.error, 0.4 * first.error);
    EXPECT_GT(second.cone, first.cone);
    EXPECT_GT(second.hump, first.hump);
  }
} // namespace

TEST(Rotation, Swept)
{
  compare(Rotation("Godunov").swept(), Rotation("limited linear").swept());
}

TEST(Rotation, Overlap)
{
  compare(Rotation("Godunov").overlap(), Rotation("limited linear").overlap());
}
