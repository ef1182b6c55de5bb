// The neighbour list of a realisation on a card (state/neighbour_list.h): rows of candidates, found by
// comparing all spheres, and the pairs that are selected from them.
#pragma once

#include "engine/card/card_state.h"
#include "engine/card/card_team.h"

namespace peclet::engine {

// The cell at one moment.
struct CardCell {
  double edge_x, edge_y, edge_z, tilt;
};

class CardList {
 public:
  CardList(const CardScene& scene, const CardRealisation& own, CardProgress& at, const CardTeam& team)
      : scene_(scene), own_(own), at_(at), team_(team) {}

  CardCell cell(double strain) const {
    return {scene_.edge_x, scene_.edge_y, scene_.edge_z,
            at_.start_tilt + strain * scene_.edge_y + at_.flips * scene_.edge_x};
  }

  // Returns the displacement below which the list holds at this strain.
  double allowed(double strain) const { return allowed(strain - at_.listed_strain, scene_.skin, 0); }

  // Returns the largest displacement since the list was made.
  double largest_displacement(double strain) const {
    return largest_displacement(own_.listed, strain - at_.listed_strain);
  }

  // Makes a new list at the present positions, from the candidates if they still hold. Springs go from
  // own.springs to own.springs_after. Returns false if the slot has too little room.
  bool rebuild(double strain) {
    if (largest_displacement(own_.found, strain - at_.found_strain) <
        allowed(strain - at_.found_strain, scene_.skin_of_candidates, scene_.skin)) {
      return list_present(strain);
    }
    set_keys();
    change_basis(strain);
    wrap(cell(strain));
    copy(own_.position, own_.found);
    at_.found_strain = strain;
    return find_candidates() && list_present(strain);
  }

  // Makes the list again from the positions when candidates and pairs were found. Pairs and their ends are
  // then those that have springs.
  bool restore() {
    set_keys();
    return find_candidates() && list_pairs();
  }

 private:
  static double larger_of(double a, double b) { return a < b ? b : a; }

  double reach(double range, double skin) const {
    return range + skin * (scene_.smallest_range + 0.1 * (range - scene_.smallest_range));
  }
  double allowed(double strain, double skin, double inner_skin) const {
    const double size = strain < 0 ? -strain : strain;
    const double stretch = __builtin_sqrt(1 + 0.25 * strain * strain) - 0.5 * size;
    const auto left = [&](double range) {
      return 0.5 * (stretch * reach(range, skin) - reach(range, inner_skin));
    };
    const double of_smallest = left(scene_.smallest_range), of_largest = left(scene_.largest_range);
    return of_smallest < of_largest ? of_smallest : of_largest;
  }
  double largest_displacement(const CardRow* then, double strain) const {
    const auto found = team_.reduce<0, 1>(scene_.particles, [&](std::uint32_t i, auto& own) {
      const CardRow &from = then[i], &to = own_.position[i];
      const double x = to.x - from.x - strain * from.y, y = to.y - from.y, z = to.z - from.z;
      own.largest[0] = larger_of(own.largest[0], x * x + y * y + z * z);
    });
    return __builtin_sqrt(found.largest[0]);
  }

  void copy(const CardRow* from, CardRow* to) const {
    team_.each(scene_.particles, [&](std::uint32_t i) { to[i] = from[i]; });
  }

  bool list_present(double strain) {
    copy(own_.position, own_.listed);
    at_.listed_strain = strain;
    ++at_.builds;
    return list_pairs();
  }

  // Sets the keys of pairs, which do not change when spheres are wrapped.
  void set_keys() const {
    if (!scene_.springs) return;
    team_.each(at_.pairs, [&](std::uint32_t p) {
      const CardPair& pair = own_.pair[p];
      for (int c = 0; c < 3; ++c) {
        own_.key[p][c] = pair.image[c] - own_.image[pair.second][c] + own_.image[pair.first][c];
      }
    });
  }

  // Makes the cell compact again: the second lattice vector loses whole edges along x.
  void change_basis(double strain) {
    const auto count = static_cast<std::int32_t>(__builtin_floor(cell(strain).tilt / scene_.edge_x + 0.5));
    if (count == 0) return;
    at_.flips -= count;
    team_.each(scene_.particles, [&](std::uint32_t i) { own_.image[i][0] += count * own_.image[i][1]; });
    if (!scene_.springs) return;
    team_.each(at_.pairs, [&](std::uint32_t p) { own_.key[p][0] += count * own_.key[p][1]; });
  }

  void wrap(const CardCell& cell) const {
    const double image_speed = scene_.rate * cell.edge_y;
    team_.each(scene_.particles, [&](std::uint32_t i) {
      CardRow& x = own_.position[i];
      const double z = x.z / cell.edge_z, y = x.y / cell.edge_y;
      const double along_x = (x.x - cell.tilt * y) / cell.edge_x;
      const double kx = __builtin_floor(along_x), ky = __builtin_floor(y), kz = __builtin_floor(z);
      x.x -= kx * cell.edge_x + ky * cell.tilt;
      x.y -= ky * cell.edge_y;
      x.z -= kz * cell.edge_z;
      own_.velocity[i].x -= image_speed * ky;
      own_.image[i][0] += static_cast<std::int32_t>(kx);
      own_.image[i][1] += static_cast<std::int32_t>(ky);
      own_.image[i][2] += static_cast<std::int32_t>(kz);
    });
  }

  // The separation of a pair at positions x.
  struct Way {
    double x, y, z;
    double squared() const { return x * x + y * y + z * z; }
  };
  static Way way(const CardRow* x, std::uint32_t first, std::uint32_t second, const std::int8_t* image,
                 const CardCell& cell) {
    const CardRow &from = x[first], &to = x[second];
    return {to.x - from.x + (image[0] * cell.edge_x + image[1] * cell.tilt),
            to.y - from.y + image[1] * cell.edge_y, to.z - from.z + image[2] * cell.edge_z};
  }
  std::uint32_t kind(std::uint32_t first, std::uint32_t second) const {
    return scene_.size_class[first] * scene_.classes + scene_.size_class[second];
  }

  // Calls use(neighbour) for each sphere and image within the reach of candidates of sphere i, in order.
  template <class Use>
  PECLET_ALWAYS_INLINE void near_candidates(std::uint32_t i, const CardCell& cell, Use&& use) const {
    const CardRow* const x = own_.found;
    const double per_x = 1 / cell.edge_x, per_y = 1 / cell.edge_y, per_z = 1 / cell.edge_z;
    const int around = scene_.is_narrow ? 1 : 0;
    const std::uint32_t own_class = scene_.size_class[i];
    for (std::uint32_t j = 0; j < scene_.particles; ++j) {
      if (j == i) continue;
      const std::uint32_t first = i < j ? i : j, second = i < j ? j : i;
      const std::uint32_t other_class = scene_.size_class[j];
      const double reach = scene_.squared_candidate_reach[(i < j ? own_class : other_class) * scene_.classes +
                                                          (i < j ? other_class : own_class)];
      // The image of the second sphere in whose neighbourhood the nearest one lies.
      const CardRow from = x[first], to = x[second];
      const double x_apart = to.x - from.x, y_apart = to.y - from.y, z_apart = to.z - from.z;
      const auto nearest = [](double cells) { return -__builtin_floorf(static_cast<float>(cells) + 0.5F); };
      const auto kz = static_cast<double>(nearest(z_apart * per_z)),
                 ky = static_cast<double>(nearest(y_apart * per_y));
      const auto kx = static_cast<double>(nearest((x_apart + ky * cell.tilt) * per_x));
      if (around == 0) {
        // Beyond the reach in single precision, with room for its errors: most spheres.
        const auto dx = static_cast<float>(x_apart + (kx * cell.edge_x + ky * cell.tilt)),
                   dy = static_cast<float>(y_apart + ky * cell.edge_y),
                   dz = static_cast<float>(z_apart + kz * cell.edge_z);
        if (dx * dx + dy * dy + dz * dz > 1.001F * static_cast<float>(reach)) continue;
      }
      for (int dz = -around; dz <= around; ++dz) {
        for (int dy = -around; dy <= around; ++dy) {
          for (int dx = -around; dx <= around; ++dx) {
            const CardNeighbour near = {j,
                                        {static_cast<std::int8_t>(static_cast<int>(kx) + dx),
                                         static_cast<std::int8_t>(static_cast<int>(ky) + dy),
                                         static_cast<std::int8_t>(static_cast<int>(kz) + dz), 0}};
            if (way(x, first, second, near.image, cell).squared() < reach) use(near);
          }
        }
      }
    }
  }

  std::uint32_t row_begin(std::uint32_t i) const { return i * own_.room.neighbours; }

  bool find_candidates() {
    const CardCell cell = this->cell(at_.found_strain);
    const std::uint32_t room = own_.room.neighbours;
    const auto found = team_.reduce<0, 1>(scene_.particles, [&](std::uint32_t i, auto& sums) {
      const std::uint32_t begin = row_begin(i);
      std::uint32_t count = 0;
      near_candidates(i, cell, [&](const CardNeighbour& near) {
        if (count < room) {
          own_.pair_of[begin + count] = scene_.springs && i < near.other ? old_pair(i, near) : no_pair;
          own_.candidate[begin + count] = near;
        }
        ++count;
      });
      own_.candidate_count[i] = count;
      sums.largest[0] = larger_of(sums.largest[0], static_cast<double>(count));
    });
    return found.largest[0] <= static_cast<double>(room);
  }

  // Returns the pair of the last list that this one was, or no_pair.
  std::uint32_t old_pair(std::uint32_t first, const CardNeighbour& near) const {
    for (std::uint32_t e = own_.end_begin[first]; e < own_.end_begin[first + 1]; ++e) {
      const CardEnd& end = own_.end[e];
      if (end.other != near.other || end.pair_and_side % 2 != 0) continue;
      const std::int32_t* const key = own_.key[end.pair_and_side / 2];
      bool same = true;
      for (int c = 0; c < 3; ++c) {
        same = same && key[c] == near.image[c] - own_.image[near.other][c] + own_.image[first][c];
      }
      if (same) return end.pair_and_side / 2;
    }
    return no_pair;
  }

  bool is_listed(std::uint32_t i, const CardNeighbour& near, const CardCell& cell) const {
    const std::uint32_t first = i < near.other ? i : near.other, second = i < near.other ? near.other : i;
    return way(own_.listed, first, second, near.image, cell).squared() <
           scene_.squared_reach[kind(first, second)];
  }

  // Selects the pairs at the listed positions from the candidates.
  bool list_pairs() {
    const CardCell cell = this->cell(at_.listed_strain);
    team_.each(scene_.particles, [&](std::uint32_t i) {
      const std::uint32_t begin = row_begin(i), end = begin + own_.candidate_count[i];
      std::uint32_t ends = 0, pairs = 0;
      for (std::uint32_t c = begin; c < end; ++c) {
        CardNeighbour& near = own_.candidate[c];
        const bool listed = is_listed(i, near, cell);
        near.image[3] = listed ? 1 : 0;
        ends += listed ? 1 : 0;
        pairs += listed && i < near.other ? 1 : 0;
      }
      own_.row_count[i] = ends;
      own_.linked_count[i] = pairs;
    });
    const std::uint32_t ends = team_.scan(scene_.particles, own_.row_count, own_.end_begin);
    if (ends > 2 * own_.room.pairs) return false;
    at_.pairs = team_.scan(scene_.particles, own_.linked_count, own_.pair_begin);
    team_.each(scene_.particles, [&](std::uint32_t i) {
      const std::uint32_t begin = row_begin(i), end = begin + own_.candidate_count[i];
      std::uint32_t number = own_.pair_begin[i];
      for (std::uint32_t c = begin; c < end; ++c) {
        const CardNeighbour near = own_.candidate[c];
        if (near.other < i) continue;
        if (near.image[3] == 0) {
          own_.pair_of[c] = no_pair;
          continue;
        }
        own_.pair[number] = {i, near.other, {near.image[0], near.image[1], near.image[2], 0}};
        if (scene_.springs) hand_over_springs(own_.pair_of[c], number);
        own_.pair_of[c] = number++;
      }
    });
    team_.each(scene_.particles, [&](std::uint32_t i) {
      const std::uint32_t begin = row_begin(i), end = begin + own_.candidate_count[i];
      std::uint32_t next = own_.end_begin[i];
      for (std::uint32_t c = begin; c < end; ++c) {
        const CardNeighbour near = own_.candidate[c];
        if (near.image[3] == 0) continue;
        own_.end[next++] = i < near.other ? CardEnd{2 * own_.pair_of[c], near.other}
                                          : CardEnd{2 * pair_from_other(i, near) + 1, near.other};
      }
    });
    // Rows of equal length keep their order.
    team_.each(scene_.particles, [&](std::uint32_t i) {
      const std::uint32_t length = own_.row_count[i];
      std::uint32_t place = 0;
      for (std::uint32_t j = 0; j < scene_.particles; ++j) {
        const std::uint32_t other = own_.row_count[j];
        place += other > length || (other == length && j < i) ? 1 : 0;
      }
      own_.order[place] = i;
    });
    return true;
  }

  void hand_over_springs(std::uint32_t from, std::uint32_t to) const {
    for (std::size_t c = 0; c < components_of_card_springs; ++c) {
      const std::size_t begin = c * own_.room.pairs;
      own_.springs_after[begin + to] = from == no_pair ? 0 : own_.springs[begin + from];
    }
  }

  // Returns the pair that sphere i has in the row of a neighbour of smaller number.
  std::uint32_t pair_from_other(std::uint32_t i, const CardNeighbour& near) const {
    std::uint32_t low = row_begin(near.other), high = low + own_.candidate_count[near.other];
    while (low < high) {
      const std::uint32_t middle = (low + high) / 2;
      if (own_.candidate[middle].other < i) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    const auto same = [&](const CardNeighbour& there) {
      return there.image[0] == near.image[0] && there.image[1] == near.image[1] &&
             there.image[2] == near.image[2];
    };
    while (!same(own_.candidate[low])) ++low;
    return own_.pair_of[low];
  }

  const CardScene& scene_;
  const CardRealisation& own_;
  CardProgress& at_;
  const CardTeam& team_;
};

}  // namespace peclet::engine
