// SPDX-License-Identifier: MIT
#include "topology/solid/choose.h"

#include <coin/Cbc_C_Interface.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

namespace sketchsplat {
namespace {

constexpr double kMostWork = 1e7;         // nodes times entries of the matrix: some seconds
constexpr size_t kMostEntries = 250'000;  // relaxations of more take many seconds

// Columns are yes or no; rows are sums of some of them.
class Programme {
 public:
  Programme() : model_(Cbc_newModel(), Cbc_deleteModel) {
    Cbc_setParameter(model_.get(), "logLevel", "0");
    Cbc_setParameter(model_.get(), "ratioGap", "0");
    Cbc_setParameter(model_.get(), "allowableGap", "0");
    // The relaxations are nearly whole: what Cbc does before it begins, and cuts, took ten times as
    // long as the search.
    Cbc_setParameter(model_.get(), "preProcess", "off");
    Cbc_setParameter(model_.get(), "cuts", "off");
    Cbc_setParameter(model_.get(), "heuristicsOnOff", "off");
  }
  int add_column(double price) {
    price_.push_back(price);
    return int(price_.size()) - 1;
  }
  void add_row(const std::map<int, double>& sum, char sense, double bound) {
    for (const auto& [column, factor] : sum)
      entries_.emplace_back(int(low_.size()), column, factor);
    low_.push_back(sense == 'L' ? -INFINITY : bound);
    high_.push_back(sense == 'G' ? INFINITY : bound);
  }
  // Values of the columns at the least price.
  std::vector<bool> solve(int nodes) {
    if (entries_.size() > kMostEntries) throw UndecidedChoice("too many faces are possible");
    load();
    const double affordable = kMostWork / std::max<double>(1, double(entries_.size()));
    nodes = int(std::min<double>(nodes, affordable));
    Cbc_setParameter(model_.get(), "maxNodes", std::to_string(nodes).c_str());
    Cbc_solve(model_.get());
    if (!Cbc_isProvenOptimal(model_.get()))
      throw UndecidedChoice("no choice of faces is proven to be the best");
    const double* values = Cbc_getColSolution(model_.get());
    std::vector<bool> out(price_.size());
    for (size_t i = 0; i < out.size(); ++i) out[i] = values[i] > 0.5;
    return out;
  }

 private:
  // All at once: Cbc copies what it has for every row that is added alone.
  void load() {
    const int columns = int(price_.size()), rows = int(low_.size());
    Eigen::SparseMatrix<double> matrix(rows, columns);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    const std::vector<double> none(columns, 0), all(columns, 1);
    Cbc_loadProblem(model_.get(), columns, rows, matrix.outerIndexPtr(), matrix.innerIndexPtr(),
                    matrix.valuePtr(), none.data(), all.data(), price_.data(), low_.data(),
                    high_.data());
    for (int i = 0; i < columns; ++i) Cbc_setInteger(model_.get(), i);
  }

  std::unique_ptr<Cbc_Model, void (*)(Cbc_Model*)> model_;
  std::vector<double> price_, low_, high_;  // of columns; bounds of rows
  std::vector<Eigen::Triplet<double>> entries_;
};

// A column that says whether one of two cells is chosen and the other is not.
int border(int left, int right, Programme* programme) {
  if (left < 0 || right < 0) return left < 0 ? right : left;
  const int b = programme->add_column(0);
  programme->add_row({{b, 1}, {left, -1}, {right, 1}}, 'G', 0);
  programme->add_row({{b, 1}, {left, 1}, {right, -1}}, 'G', 0);
  programme->add_row({{b, 1}, {left, -1}, {right, -1}}, 'L', 0);
  programme->add_row({{b, 1}, {left, 1}, {right, 1}}, 'L', 2);
  return b;
}

// A cell at least is chosen, or the price is paid. (A closed boundary is met twice; but along an
// edge cells that are not adjusted yet gape.)
void cover(const Cover& cover, Programme* programme) {
  std::map<int, double> sum;
  for (const int c : cover.cells) sum[c] = 1;
  sum[programme->add_column(cover.price)] = 1;
  programme->add_row(sum, 'G', 1);
}

// One face costs less than two.
void merge(int a, int b, double saved, Programme* programme) {
  const int both = programme->add_column(-saved);
  programme->add_row({{both, 1}, {a, -1}}, 'L', 0);
  programme->add_row({{both, 1}, {b, -1}}, 'L', 0);
}

// Sets of cells of which any two are a pair, so that each pair is in one at least: one row for each
// bounds the linear programme better than one for each pair.
std::vector<std::vector<int>> cliques(const std::vector<std::pair<int, int>>& pairs, int cells) {
  std::vector<std::set<int>> beside(cells);
  for (const auto& [a, b] : pairs) {
    beside[a].insert(b);
    beside[b].insert(a);
  }
  std::set<std::pair<int, int>> covered;
  std::vector<std::vector<int>> out;
  for (const auto& [a, b] : pairs) {
    if (covered.count(std::minmax(a, b))) continue;
    std::vector<int> clique = {a, b};
    for (const int c : beside[a])
      if (std::all_of(clique.begin(), clique.end(), [&](int k) { return beside[k].count(c) > 0; }))
        clique.push_back(c);
    for (const int i : clique)
      for (const int k : clique) covered.insert(std::minmax(i, k));
    out.push_back(std::move(clique));
  }
  return out;
}

void exclude(const ChosenCells& other, Programme* programme) {
  std::map<int, double> sum;
  int chosen = 0;
  for (int c = 0; c < int(other.cell.size()); ++c) {
    sum[c] = other.cell[c] ? -1 : 1;
    chosen += other.cell[c];
  }
  programme->add_row(sum, 'G', 1 - chosen);
}

// A stroke that is no edge costs less if others are, which it may be seen twice.
void add_doubles(const CellChoice& choice, int first, Programme* programme) {
  for (const Double& d : choice.doubles) {
    const double saved = choice.unused_price[d.stroke] - choice.double_price;
    if (saved <= 0) continue;
    const int twice = programme->add_column(-saved);
    for (const std::vector<int>& place : d.along) {
      std::map<int, double> sum = {{twice, 1}};
      for (const int other : place) sum[first + other] = -1;
      programme->add_row(sum, 'L', 0);
    }
    programme->add_row({{twice, 1}, {first + d.stroke, 1}}, 'L', 1);
  }
}

// Per stroke the column that says whether it is open, or -1. `faces`: sums of the faces at strokes.
std::vector<int> add_open(const CellChoice& choice, int first,
                          std::vector<std::map<int, double>>* faces, Programme* programme) {
  std::vector<int> out(choice.used_price.size(), -1);
  for (size_t s = 0; s < choice.open_price.size(); ++s) {
    if (std::isinf(choice.open_price[s])) continue;
    out[s] = programme->add_column(choice.open_price[s] - choice.unused_price[s]);
    (*faces)[s][out[s]] = -1;
    programme->add_row({{out[s], 1}, {first + int(s), 1}}, 'L', 1);
  }
  return out;
}

bool seen_twice(const Double& d, const std::vector<bool>& edge) {
  return !edge[d.stroke] &&
         std::all_of(d.along.begin(), d.along.end(), [&](const std::vector<int>& place) {
           return std::any_of(place.begin(), place.end(), [&](int s) { return edge[s]; });
         });
}

}  // namespace

ChosenCells choose_cells(const CellChoice& choice, const std::vector<ChosenCells>& others,
                         int nodes) {
  const int cells = int(choice.cells.size()), strokes = int(choice.used_price.size());
  if (cells == 0) {  // nothing to choose, which the solver does not like
    ChosenCells none;
    none.stroke.assign(strokes, false);
    none.twice = none.open = none.stroke;
    for (const double price : choice.unused_price) none.price += price;
    return none;
  }
  Programme programme;
  for (const double price : choice.cell_price) programme.add_column(price);
  for (int s = 0; s < strokes; ++s)
    programme.add_column(choice.used_price[s] - choice.unused_price[s]);
  std::vector<std::map<int, double>> faces(strokes);
  for (const auto& [where, side] : sides_of(choice.cells))
    faces[where.first][border(side.first, side.second, &programme)] += 1;
  const std::vector<int> open = add_open(choice, cells, &faces, &programme);
  for (int s = 0; s < strokes; ++s) {
    faces[s][cells + s] -= 2;
    programme.add_row(faces[s], 'E', 0);
  }
  for (const std::vector<int>& clique : cliques(choice.exclusive, cells)) {
    std::map<int, double> sum;
    for (const int c : clique) sum[c] = 1;
    programme.add_row(sum, 'L', 1);
  }
  for (const Cover& c : choice.covers) cover(c, &programme);
  for (const auto& [pair, saved] : choice.merges) merge(pair.first, pair.second, saved, &programme);
  for (const ChosenCells& other : others) exclude(other, &programme);
  add_doubles(choice, cells, &programme);

  const std::vector<bool> values = programme.solve(nodes);
  ChosenCells out;
  out.cell.assign(values.begin(), values.begin() + cells);
  out.stroke.assign(values.begin() + cells, values.begin() + cells + strokes);
  for (const int column : open) out.open.push_back(column >= 0 && values[column]);
  for (int c = 0; c < cells; ++c) out.price += out.cell[c] ? choice.cell_price[c] : 0;
  out.twice.assign(strokes, false);
  for (const Double& d : choice.doubles) out.twice[d.stroke] = seen_twice(d, out.stroke);
  for (int s = 0; s < strokes; ++s)
    out.price += out.stroke[s]  ? choice.used_price[s]
                 : out.open[s]  ? choice.open_price[s]
                 : out.twice[s] ? std::min(choice.double_price, choice.unused_price[s])
                                : choice.unused_price[s];
  for (const auto& [pair, saved] : choice.merges)
    out.price -= out.cell[pair.first] && out.cell[pair.second] ? saved : 0;
  for (const Cover& c : choice.covers) {
    int met = 0;
    for (const int cell : c.cells) met += out.cell[cell];
    out.price += met == 0 ? c.price : 0;
  }
  return out;
}

}  // namespace sketchsplat
