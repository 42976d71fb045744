#ifndef mitre_base_plugin_registry_h
#define mitre_base_plugin_registry_h

#include <deal.II/base/exceptions.h>
#include <deal.II/base/parameter_handler.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>

namespace mitre::base
{
  /**
   * The plugins of one kind (constitutive laws, boundary conditions, instruments) by the
   * names that a parameter file uses for them.
   *
   * Nothing registers itself. A room keeps each registry as a local static variable of a
   * function in its <code>library.cc</code>, which adds all plugins where the variable is
   * made, so that the list can be read in one place and does not depend on the order in
   * which static variables are initialised:
   * @code
   *   template <int dim>
   *   const base::PluginRegistry<ConstitutiveLaw<dim>> &
   *   constitutive_laws()
   *   {
   *     static const auto registry = [] {
   *       base::PluginRegistry<ConstitutiveLaw<dim>> laws("constitutive law");
   *       laws.template add<NeoHookean<dim>>("neo-Hookean", "W = C1 (I1 - 3)");
   *       return laws;
   *     }();
   *     return registry;
   *   }
   * @endcode
   *
   * @tparam Interface the base class of the plugins
   * @tparam Arguments what their constructors take
   */
  template <typename Interface, typename... Arguments>
  class PluginRegistry
  {
  public:
    using Factory           = std::function<std::unique_ptr<Interface>(Arguments...)>;
    using DeclareParameters = std::function<void(dealii::ParameterHandler &)>;

    /**
     * An empty registry.
     *
     * @param kind what the plugins are, in the singular, for messages: "constitutive law"
     */
    explicit PluginRegistry(std::string kind)
      : kind_(std::move(kind))
    {
    }

    /**
     * Add a plugin that has no class of its own.
     *
     * @param name what the parameter file calls it
     * @param description one line for the parameter reference
     * @param factory makes one
     * @param declare declares its parameters in the subsection that has been entered
     */
    void add(const std::string &name,
             const std::string &description,
             Factory factory,
             DeclareParameters declare)
    {
      AssertThrow(
        entries_.count(name) == 0,
        dealii::ExcMessage("The " + kind_ + " '" + name + "' is registered twice."));
      names_.push_back(name);
      entries_[name] = {description, std::move(factory), std::move(declare)};
    }

    /**
     * Add the class @p Plugin, which has a constructor with @p Arguments and a static
     * function <code>declare_parameters(dealii::ParameterHandler &)</code>.
     */
    template <typename Plugin>
    void add(const std::string &name, const std::string &description)
    {
      add(
        name,
        description,
        [](Arguments... arguments) -> std::unique_ptr<Interface> {
          return std::make_unique<Plugin>(arguments...);
        },
        [](dealii::ParameterHandler &prm) { Plugin::declare_parameters(prm); });
    }

    /** The names in the order in which they were added. */
    const std::vector<std::string> &names() const
    {
      return names_;
    }

    bool contains(const std::string &name) const
    {
      return entries_.count(name) != 0;
    }

    const std::string &kind() const
    {
      return kind_;
    }

    const std::string &description(const std::string &name) const
    {
      return find(name).description;
    }

    /** The names as dealii::Patterns::Selection takes them: "a|b|c". */
    std::string pattern() const
    {
      std::string text;
      for (const std::string &name : names_)
        text += (text.empty() ? "" : "|") + name;
      return text;
    }

    /** The names and descriptions, one a line, for the help text of a parameter. */
    std::string help() const
    {
      std::string text;
      for (const std::string &name : names_)
        text += (text.empty() ? "" : "\n") + name + ": " + entries_.at(name).description;
      return text;
    }

    /**
     * Make the plugin @p name. Throws UserError, which lists the known names and the
     * nearest one, if there is none of that name.
     */
    std::unique_ptr<Interface> create(const std::string &name,
                                      Arguments... arguments) const
    {
      return find(name).factory(arguments...);
    }

    /**
     * Declare the parameters of the plugin @p name in the subsection that has been
     * entered. Throws as create() does.
     */
    void declare_parameters(const std::string &name, dealii::ParameterHandler &prm) const
    {
      find(name).declare(prm);
    }

  private:
    struct Entry
    {
      std::string description;
      Factory factory;
      DeclareParameters declare;
    };

    const Entry &find(const std::string &name) const
    {
      const auto entry = entries_.find(name);
      AssertThrow(entry != entries_.end(),
                  UserError("There is no " + kind_ + " '" + name + "'. " +
                            suggest_name(name, names_)));
      return entry->second;
    }

    std::string kind_;
    std::vector<std::string> names_;
    std::map<std::string, Entry> entries_;
  };
} // namespace mitre::base

#endif
