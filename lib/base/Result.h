// A value, or an error that says what was expected and what was found.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace terrain {

/// Why something could not be done, in the words a user needs to mend it.
struct Error {
    std::string subject;   ///< file, field or option that the error is about
    std::string expected;  ///< what would have been right
    std::string found;     ///< what was there instead

    /// One line: "subject: expected ..., found ...".
    std::string message() const {
        std::string text = subject;
        if (!expected.empty()) text += ": expected " + expected;
        if (!found.empty()) text += (expected.empty() ? ": " : ", found ") + found;
        return text;
    }
};

/// Holds a T or an Error. Bad data travels through this type: it never throws and never asserts.
template <class T>
class Result {
public:
    Result(T value) : content_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : content_(std::in_place_index<1>, std::move(error)) {}

    explicit operator bool() const { return content_.index() == 0; }
    const T& value() const& { return std::get<0>(content_); }
    T& value() & { return std::get<0>(content_); }
    T&& value() && { return std::get<0>(std::move(content_)); }
    const Error& error() const { return std::get<1>(content_); }

private:
    std::variant<T, Error> content_;
};

}  // namespace terrain
