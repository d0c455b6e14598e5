#pragma once

#include "cases/grain_section.h"
#include "discrete/contacts.h"

namespace antiform::cases
{
/// When linear contacts are wanted: those that act before anything has broken, or all
/// that breaks may call for.
enum class ContactsFor
{
  intact_scene,
  broken_scene
};

/// Laws and margin of the linear contacts of a scene, and the pairs that are installed
/// without a bond. Finds no candidates yet.
discrete::Contacts make_contacts(const Parameters &parameters,
                                 const GrainSection &section,
                                 ContactsFor what);
} // namespace antiform::cases
