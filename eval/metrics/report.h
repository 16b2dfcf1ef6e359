// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "eval/metrics/evaluate.h"
#include "eval/metrics/scenes.h"

namespace sketchsplat {

/// One row of numbers under its headings, aligned; `name` stands at its beginning.
/// F, P, R in per cent, Acc and Comp in thousandths; F5/F2/F1 "fine"; F5vis: fine, of the visible
/// truth; strF, type, jncF, dup: per cent of Structure; par: parameters per true parameter. "-"
/// where there is no number.
std::string to_table(const Evaluation& evaluation, const std::string& name = "");

/// All numbers as a JSON object, indented; null where there is no number:
///   acc, comp (thousandths), chamfer = their sum, each also _median, _p95, _worst; comp_visible
///   P20 R20 F20 ... F1, R20_visible F20_visible ... F1_visible (per cent)
///   fine        the same keys at 5, 2, 1
///   structure   null, or strokes, edges, matched, f, precision, recall, right_type, duplicated,
///               length_error (per cent), strokes_per_edge, length, true_length, parameters,
///               true_parameters, parameters_per_true, junctions {predicted, truth, matched,
///               precision, recall, f}, visible: null or {edges, matched, recall, f, junctions,
///               junction_recall}
///   solid       only if solids are compared: the members of SolidComparison
///   worst_edges, worst_strokes   lists of {name, type, length, share (per cent), worst
///               (thousandths)}
///   protocol, prediction, ground_truth, lines, curves, samples, truth_samples
std::string to_json(const Evaluation& evaluation);

/// Every stroke as a row of CSV: scene, stroke (its name), kind, length, share (per cent of it
/// within 0.005 of the truth), worst (thousandths).
std::string strokes_to_csv(const std::vector<SceneEvaluation>& scenes);

/// The comparison of solids in words, a line; empty if there is none.
std::string solid_row(const Evaluation& evaluation);

/// The worst curves in words, a line each; empty if all are right.
std::string worst_curves(const Evaluation& evaluation);

/// All numbers of the JSON object under their keys, "structure.junctions.f"; NaN where it says
/// null.
using NamedNumbers = std::vector<std::pair<std::string, double>>;
NamedNumbers numbers_of(const Evaluation& evaluation);

/// Mean of each number over the rows that have it (so F is a mean of F); NaN where none has.
NamedNumbers mean_of(const std::vector<NamedNumbers>& rows);

/// A row per scene and their mean below: as a table; as CSV (scene, missing, numbers_of());
/// as JSON {scenes: [{scene, missing, to_json()...}], missing: count, mean: {numbers_of()}}.
std::string scenes_to_table(const std::vector<SceneEvaluation>& scenes);
std::string scenes_to_csv(const std::vector<SceneEvaluation>& scenes);
std::string scenes_to_json(const std::vector<SceneEvaluation>& scenes);

}  // namespace sketchsplat
