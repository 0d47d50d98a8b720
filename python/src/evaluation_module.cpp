// Errors against ground truth.
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "modules.hpp"
#include "rilo/evaluation/evaluation.hpp"

namespace rilo::python {

void add_evaluation(py::module_& module) {
  module.def(
      "evaluate",
      [](const py::object& truth, const py::object& estimate) {
        const std::vector<SE3> true_poses = poses_of(truth, "truth");
        const Evaluation e = evaluate(true_poses, poses_of(estimate, "estimate"));
        py::dict figures;
        figures["poses"] = e.poses;
        figures["path_m"] = e.path_m;
        figures["t_rel_pct"] = e.kitti.t_rel_pct();
        figures["r_rel_deg_per_100m"] = e.kitti.r_rel_deg_100m();
        figures["ape_rmse_m"] = e.ape.translation_m.rmse;
        figures["ape_unaligned_rmse_m"] = e.ape_unaligned.translation_m.rmse;
        figures["end_error_m"] = e.end_error_m;
        return figures;
      },
      py::arg("truth"), py::arg("estimate"),
      "Errors of poses (N, 4, 4) or (N, 3, 4) of the same sensor at the same times: a dict with figures as in "
      "metrics.json. t_rel_pct and r_rel_deg_per_100m: over segments of 100 to 800 m, of paths below 150 m over "
      "shorter ones; None where nothing moved.");
}

}  // namespace rilo::python
