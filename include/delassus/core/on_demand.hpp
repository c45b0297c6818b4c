/// A member whose class need not be known where it is held.
#pragma once

namespace delassus::inner {

/// A T of its own on the heap, made when it is first asked for; a copy has a copy of it.
template <class T>
class OnDemand {
 public:
  constexpr OnDemand() = default;
  OnDemand(const OnDemand& other);
  OnDemand(OnDemand&& other) noexcept : value_(other.value_) { other.value_ = nullptr; }
  /// This takes the value of the copy, and the copy ends this one's.
  OnDemand& operator=(OnDemand other) noexcept {
    T* const mine = value_;
    value_ = other.value_;
    other.value_ = mine;
    return *this;
  }
  ~OnDemand();

  T& operator*();
  T* operator->() { return &**this; }

 private:
  T* value_ = nullptr;
};

template <class T>
OnDemand<T>::OnDemand(const OnDemand& other) : value_(other.value_ ? new T(*other.value_) : nullptr) {}
template <class T>
OnDemand<T>::~OnDemand() {
  delete value_;
}
template <class T>
T& OnDemand<T>::operator*() {
  if (!value_) value_ = new T();
  return *value_;
}

}  // namespace delassus::inner
