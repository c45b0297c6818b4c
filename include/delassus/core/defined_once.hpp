/// A class whose constructors, destructor and assignments are functions that a program can compile once.
#pragma once

namespace delassus::inner {

/// A T. What the compiler defines for T by itself it defines in every file that makes or ends one; this one's members are
/// templates outside of the class, which `extern template struct DefinedOnce<T>` leaves to another file.
template <class T>
struct DefinedOnce : T {
  DefinedOnce();
  DefinedOnce(const DefinedOnce& other);
  DefinedOnce(DefinedOnce&& other) noexcept;
  DefinedOnce& operator=(const DefinedOnce& other);
  DefinedOnce& operator=(DefinedOnce&& other) noexcept;
  ~DefinedOnce();

  /// For functions that are templates of T.
  T& itself() { return *this; }
};

template <class T>
DefinedOnce<T>::DefinedOnce() = default;
template <class T>
DefinedOnce<T>::DefinedOnce(const DefinedOnce&) = default;
template <class T>
DefinedOnce<T>::DefinedOnce(DefinedOnce&&) noexcept = default;
template <class T>
DefinedOnce<T>& DefinedOnce<T>::operator=(const DefinedOnce&) = default;
template <class T>
DefinedOnce<T>& DefinedOnce<T>::operator=(DefinedOnce&&) noexcept = default;
template <class T>
DefinedOnce<T>::~DefinedOnce() = default;

}  // namespace delassus::inner
