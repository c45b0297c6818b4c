// expect: delassus: a law needs rows
template <class Law>
consteval bool law_is_sound() {
  constexpr bool has_rows = requires { Law::rows; };
  static_assert(has_rows, "delassus: a law needs rows");
  return has_rows;
}

template <class Law>
struct Loop {
  void step() {
    if constexpr (law_is_sound<Law>()) static_assert(Law::rows > 0, "an unsound law must not come here");
  }
};

struct Rope {};

int main() { Loop<Rope>{}.step(); }
