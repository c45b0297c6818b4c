/// A file of HDF5 with the arrays of numbers in it, refused by name where it is not as expected.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/math/linear.hpp>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <hdf5.h>

namespace delassus::inner {

/// What HDF5 lets one open, closed with its scope.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& from) noexcept : id_(std::exchange(from.id_, -1)), close_(from.close_) {}
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t get() const { return id_; }
  bool is_open() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Silences HDF5's own messages on stderr for a scope: what is wrong is told by an exception.
class Hdf5Silence {
 public:
  Hdf5Silence() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  Hdf5Silence(const Hdf5Silence&) = delete;
  Hdf5Silence& operator=(const Hdf5Silence&) = delete;
  ~Hdf5Silence() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

class Hdf5File {
 public:
  static Hdf5File open(const std::string& path, bool for_writing = false) {
    const Hdf5Silence silence;
    Hdf5File file(path, H5Fopen(path.c_str(), for_writing ? H5F_ACC_RDWR : H5F_ACC_RDONLY, H5P_DEFAULT));
    DELASSUS_EXPECT(file.file_.is_open(),
                    "cannot open '" + path + "' as a file of HDF5; is it there, and is it one?");
    return file;
  }
  /// What was there is lost.
  static Hdf5File create(const std::string& path) {
    const Hdf5Silence silence;
    Hdf5File file(path, H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
    DELASSUS_EXPECT(file.file_.is_open(),
                    "cannot write '" + path + "'; is the folder there, and may you write?");
    return file;
  }

  void expect(bool holds, const std::string& reason) const { DELASSUS_EXPECT(holds, path_ + ": " + reason); }

  /// Every group on the way must be there.
  bool has(const std::string& name) const {
    const Hdf5Silence silence;
    return H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0;
  }

  std::vector<double> numbers(const std::string& name) const { return read<double>(name, H5T_NATIVE_DOUBLE); }
  std::vector<int> integers(const std::string& name) const { return read<int>(name, H5T_NATIVE_INT); }
  int integer(const std::string& name) const {
    const std::vector<int> one = integers(name);
    expect(one.size() == 1, name + " must be one number");
    return one[0];
  }
  /// Finite, and `count` of them.
  std::vector<double> numbers(const std::string& name, std::size_t count) const {
    std::vector<double> values = numbers(name);
    expect(values.size() == count, name + " has " + std::to_string(values.size()) +
                                       " numbers and must have " + std::to_string(count));
    for (const double x : values) expect(std::isfinite(x), name + " has a number that is not finite");
    return values;
  }
  std::vector<Vec3> vectors(const std::string& name, std::size_t count) const {
    const std::vector<double> values = numbers(name, 3 * count);
    std::vector<Vec3> to;
    for (std::size_t i = 0; i < count; ++i)
      to.push_back({values[3 * i], values[3 * i + 1], values[3 * i + 2]});
    return to;
  }

  void group(const std::string& name) {
    const Hdf5Handle made(H5Gcreate2(file_.get(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                          H5Gclose);
    expect(made.is_open(), "cannot make the group " + name);
  }
  void write(const std::string& name, int value) { write(name, std::vector<int>{value}); }
  void write(const std::string& name, const std::vector<int>& values) {
    put_array(name, H5T_NATIVE_INT, values.size(), values.data());
  }
  void write(const std::string& name, const std::vector<double>& values) {
    put_array(name, H5T_NATIVE_DOUBLE, values.size(), values.data());
  }
  void write_text(const std::string& name, const std::string& text) {
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), one(H5Screate(H5S_SCALAR), H5Sclose);
    H5Tset_size(type.get(), text.size() + 1);  // with its end
    put(name, type.get(), one.get(), text.c_str());
  }

 private:
  Hdf5File(std::string path, hid_t id) : path_(std::move(path)), file_(id, H5Fclose) {}

  template <class T>
  std::vector<T> read(const std::string& name, hid_t type) const {
    const Hdf5Silence silence;
    const Hdf5Handle data(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
    expect(data.is_open(), "it has no " + name);
    const Hdf5Handle space(H5Dget_space(data.get()), H5Sclose), kind(H5Dget_type(data.get()), H5Tclose);
    const H5T_class_t is = H5Tget_class(kind.get());
    expect(is == H5T_INTEGER || is == H5T_FLOAT, name + " holds no numbers");
    const hssize_t count = H5Sget_simple_extent_npoints(space.get());
    expect(count >= 0, name + " is no array");
    // The extent of a damaged file may be any number; what is packed grows by 1032 at most.
    hsize_t bytes = 0;
    H5Fget_filesize(file_.get(), &bytes);
    expect(hsize_t(count) / 1032 <= bytes,
           name + " claims " + std::to_string(count) + " numbers, more than its file can hold");
    std::vector<T> values{};
    values.resize(std::size_t(count));
    expect(count == 0 || H5Dread(data.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
           "cannot read " + name);
    return values;
  }
  void put_array(const std::string& name, hid_t type, std::size_t count, const void* values) {
    const hsize_t size = count;
    const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
    put(name, type, space.get(), values);
  }
  void put(const std::string& name, hid_t type, hid_t space, const void* values) {
    const Hdf5Handle data(
        H5Dcreate2(file_.get(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    expect(data.is_open() && (H5Sget_simple_extent_npoints(space) == 0 ||
                              H5Dwrite(data.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0),
           "cannot write " + name);
  }

  std::string path_;
  Hdf5Handle file_;
};

}  // namespace delassus::inner
