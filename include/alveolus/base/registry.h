// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_registry_h
#define alveolus_base_registry_h

#include <alveolus/base/errors.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace alveolus
{
  /**
   * Names of the classes that implement @p Interface, each with a factory and a
   * text (equations, each symbol tied to its parameter) that becomes the
   * manual. A class enters by ALVEOLUS_REGISTER at the end of its source file.
   */
  template <class Interface>
  class Registry
  {
  public:
    /** Makes an object with default parameters. */
    using Factory = std::function<std::unique_ptr<Interface>()>;

    struct Entry
    {
      std::string description; ///< equations and sources, for the manual
      Factory     factory;     ///< makes an object
    };

    /**
     * Add a class, see ALVEOLUS_REGISTER; one of the same name is replaced.
     * @return true
     */
    static bool
    add(const std::string &name,
        const std::string &description,
        Factory            factory)
    {
      entries()[name] = {description, std::move(factory)};
      return true;
    }

    /**
     * Make an object of the class registered as @p name.
     * @param where the parameter that holds the name, for the message
     * @throws InputError listing the known names if there is none
     */
    static std::unique_ptr<Interface>
    create(const std::string &name, const std::string &where)
    {
      const auto entry = entries().find(name);
      if (entry == entries().end())
        throw InputError(where,
                         "there is no '" + name + "'",
                         "known are: " + names(", "));
      return entry->second.factory();
    }

    /** The known names in alphabetical order, put together by @p separator. */
    static std::string
    names(const std::string &separator)
    {
      std::string result;
      for (const auto &entry : entries())
        result += (result.empty() ? "" : separator) + entry.first;
      return result;
    }

    /** All classes by name. */
    static std::map<std::string, Entry> &
    entries()
    {
      static std::map<std::string, Entry> all;
      return all;
    }
  };
} // namespace alveolus

#define ALVEOLUS_JOIN_(a, b) a##b
#define ALVEOLUS_JOIN(a, b) ALVEOLUS_JOIN_(a, b)

/** Register @p Class under @p name in the registry of @p Interface. */
#define ALVEOLUS_REGISTER(Interface, Class, name, description)            \
  namespace                                                               \
  {                                                                       \
    [[maybe_unused]] const bool ALVEOLUS_JOIN(registered_, __COUNTER__) = \
      alveolus::Registry<Interface>::add(name, description, [] {          \
        return std::make_unique<Class>();                                 \
      });                                                                 \
  }

/** The same for an interface and a class that are templates of the dimension.
 */
#define ALVEOLUS_REGISTER_DIM(Interface, Class, name, description) \
  ALVEOLUS_REGISTER(Interface<2>, Class<2>, name, description)     \
  ALVEOLUS_REGISTER(Interface<3>, Class<3>, name, description)

#endif
