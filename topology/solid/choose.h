// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "topology/solid/evidence.h"

namespace sketchsplat {

/// A set of cells of which one must be chosen, or it costs.
struct Cover {
  std::vector<int> cells;
  double price = 0;  ///< [nat]
};

/// A stroke that may be others seen twice: of each set, one must be an edge.
struct Double {
  int stroke = -1;
  std::set<std::vector<int>> along;  ///< strokes beside one or more places of it, ascending
};

/// Which cells bound the solid, and what each choice costs [nat].
struct CellChoice {
  std::vector<Cell> cells;
  std::vector<double> cell_price;              ///< per cell: of its being a part of the boundary
  std::vector<double> used_price;              ///< per stroke: of its being an edge
  std::vector<double> unused_price;            ///< per stroke: of its being none
  /// Per stroke: of its bordering one face and something that nobody knows; HUGE_VAL: cannot be.
  /// Empty: no stroke can.
  std::vector<double> open_price;
  std::vector<std::pair<int, int>> exclusive;  ///< pairs of cells, of which one may be chosen
  std::vector<Cover> covers;
  std::vector<Double> doubles;
  double double_price = 0;  ///< [nat] of a stroke that is other edges seen twice
  /// Cells of one surface on both sides of a closed stroke, and what it saves [nat] to choose both:
  /// they are one face then.
  std::vector<std::pair<std::pair<int, int>, double>> merges;
};

struct ChosenCells {
  std::vector<bool> cell;    ///< is it a part of the boundary?
  std::vector<bool> stroke;  ///< is it an edge, where two faces of different surfaces meet?
  std::vector<bool> twice;   ///< is it none, but another one seen twice?
  std::vector<bool> open;    ///< is it an edge of one face alone?
  double price = 0;          ///< of all, nat
};

/// Nobody knows which choice is the best.
struct UndecidedChoice : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The cheapest choice in which every edge has two faces, unless it is open: an integer programme,
/// solved exactly. A stroke between two chosen cells of one surface, or between none, is no edge.
/// Cells that are all chosen in one of the `other` choices, and no more, are not chosen again.
/// Without any cells that close: no cells, which is a choice, too. Throws UndecidedChoice if that
/// takes more than so many nodes of the search tree, fewer of a large programme: a count, so that
/// any machine comes to the same end.
ChosenCells choose_cells(const CellChoice& choice, const std::vector<ChosenCells>& others,
                         int nodes);

}  // namespace sketchsplat
