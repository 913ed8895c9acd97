/// \file printed.cpp  Sets this thread's locale to "C" (uselocale); vsnprintf() for the length, then for the text.
#include "common/printed.hpp"

#include <cstdarg>
#include <cstdio>
#include <locale.h>

namespace quadedge {
namespace {

/// This thread's locale is "C" while it lives.
class NeutralLocale {
 public:
  NeutralLocale() : before_(uselocale(neutral())) {}
  ~NeutralLocale() { uselocale(before_); }
  NeutralLocale(const NeutralLocale&) = delete;
  NeutralLocale& operator=(const NeutralLocale&) = delete;

 private:
  static locale_t neutral() {
    static const locale_t made = newlocale(LC_ALL_MASK, "C", nullptr);
    return made;
  }
  locale_t before_;
};

}  // namespace

std::string printed(const char* format, ...) {
  const NeutralLocale neutral;
  std::va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  std::string text(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, format, arguments)), '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  va_end(arguments);
  return text;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

}  // namespace quadedge
