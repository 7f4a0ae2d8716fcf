// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// output_map: what the rendered map looks like.
#include "oort/parameters/internal/declare.hpp"

namespace oort {

void declare_grid_probabilities(const Section& v, ProbabilityGridParameters& p, bool insert_free_space) {
  v(p.insert_free_space, "insert_free_space", insert_free_space,
    "Whether cells that a beam crosses are updated as free.");
  declare_hit_and_miss(v, p);
}

void declare_hit_and_miss(const Section& v, ProbabilityGridParameters& p) {
  v(p.hit_probability, "hit_probability", {0.55, "probability", {0.501, 0.999}},
    "A hit multiplies the odds of its cell by the odds of this.");
  v(p.miss_probability, "miss_probability", {0.49, "probability", {0.001, 0.499}},
    "A beam that crosses a cell multiplies its odds by the odds of this.");
}

void declare_output_map(const Section& v, OutputMapParameters& p) {
  const Section grid = v.section("probability_grid");
  grid(p.probability_grid.resolution, "resolution", {0.05, "m", {0.005, 1.0}}, "Cell of the rendered map.");
  declare_grid_probabilities(grid, p.probability_grid, true);
  grid(p.probability_grid.clear_infs, "clear_infs", true,
       "Whether beams that saw nothing (inf) clear cells along their first part.");
  grid(p.probability_grid.inf_clear_dist, "inf_clear_dist", {0.5, "m", {0.0, 100.0}}, "How far such beams clear.");

  const Section threshold = v.section("threshold");
  threshold(p.threshold.max_free, "max_free", {48, "%", {0, 100}}, "Cells up to this probability are free.");
  threshold(p.threshold.min_occupied, "min_occupied", {55, "%", {0, 100}},
            "Cells from this probability on are occupied.");

  v(p.robot_radius, "robot_radius", {0.15, "m", {0.0, 5.0}},
    "A disc of this radius is set free around every node, which keeps doorways open; 0: none.");
  v(p.footprint_x, "footprint_x", {0.0, "m", {-5.0, 5.0}},
    "Where the disc's centre is, seen from the sensor: ahead of it. For a disc around the base: where the base is.")
      .own(0.0);
  v(p.footprint_y, "footprint_y", {0.0, "m", {-5.0, 5.0}}, "The same to its left.").own(0.0);
  v(p.clean_map, "clean_map", false, "Whether speckle is removed from `map`, too, and not from `map_cleaned` alone.")
      .own(false);
  v(p.speckle_strategy, "speckle_strategy", {"median", {"median", "morphological"}},
    "How speckle is removed from the cleaned map.");

  const Section morphological = v.section("morphological");
  morphological(p.morphological.free_space_morpho_iterations, "free_space_morpho_iterations", {1, "", {0, 20}},
                "Iterations on the layer of free cells.");
  morphological(p.morphological.occupied_morpho_iterations, "occupied_morpho_iterations", {1, "", {0, 20}},
                "Iterations on the layer of occupied cells.");

  const Section median = v.section("median");
  median(p.median.kernel_size, "kernel_size", {3, "cells", {1, 31}}, "Width of the median filter; odd.");
  median(p.median.iter, "iter", {2, "", {0, 20}}, "How often the median filter runs.");
}

}  // namespace oort
