// SPDX-License-Identifier: BSD-3-Clause
// XMP packets (ISO 16684-1) of the base and of the gain map, as Android's Ultra HDR image format 1.1 describes them.
#include <cstdlib>
#include <sstream>
#include <vector>

#include <pimg/detail/format.h>
#include <pugixml.hpp>

#include "gain_metadata.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr const char* kGainMapSpace = "http://ns.adobe.com/hdr-gain-map/1.0/";
constexpr const char* kContainerSpace = "http://ns.google.com/photos/1.0/container/";
constexpr const char* kItemSpace = "http://ns.google.com/photos/1.0/container/item/";
constexpr const char* kRdfSpace = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";

/// The properties, in the order of GainChannel and the headrooms.
constexpr const char* kChannelProperties[] = { "GainMapMin", "GainMapMax", "Gamma", "OffsetSDR", "OffsetHDR" };

double GainChannel::*const kChannelMembers[] = { &GainChannel::min, &GainChannel::max, &GainChannel::gamma,
                                                 &GainChannel::base_offset, &GainChannel::alternate_offset };

// ISO 16684-1, 7.3.2: what marks a packet, and that it is not to be changed in place.
const std::string kPacketBegin = "<?xpacket begin=\"\xEF\xBB\xBF\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>";
const std::string kPacketEnd = "<?xpacket end=\"r\"?>";

std::string text_of(const pugi::xml_document& document)
{
    std::ostringstream text;
    document.child("x:xmpmeta").print(text, "", pugi::format_raw);
    return kPacketBegin + text.str() + kPacketEnd;
}

/// An empty packet's <rdf:RDF>.
pugi::xml_node start_packet(pugi::xml_document& document)
{
    document.reset();
    pugi::xml_node meta = document.append_child("x:xmpmeta");
    meta.append_attribute("xmlns:x") = "adobe:ns:meta/";
    pugi::xml_node rdf = meta.append_child("rdf:RDF");
    rdf.append_attribute("xmlns:rdf") = kRdfSpace;
    return rdf;
}

pugi::xml_node add_description(pugi::xml_node rdf)
{
    pugi::xml_node description = rdf.append_child("rdf:Description");
    description.append_attribute("rdf:about") = "";
    description.append_attribute("xmlns:hdrgm") = kGainMapSpace;
    description.append_attribute("hdrgm:Version") = "1.0";
    return description;
}

void add_item(pugi::xml_node items, const char* meaning, std::size_t size)
{
    pugi::xml_node entry = items.append_child("rdf:li");
    entry.append_attribute("rdf:parseType") = "Resource";
    pugi::xml_node item = entry.append_child("Container:Item");
    item.append_attribute("Item:Semantic") = meaning;
    item.append_attribute("Item:Mime") = "image/jpeg";
    if (size != 0)
        item.append_attribute("Item:Length") = static_cast<unsigned long long>(size);
}

/// The prefix of a name space in the packet, with its colon; `usual` if the packet does not declare one.
std::string prefix_of(const pugi::xml_document& document, const char* space, const char* usual)
{
    const pugi::xml_node node = document.find_node([&](const pugi::xml_node& candidate) {
        for (const pugi::xml_attribute attribute : candidate.attributes())
            if (std::string_view(attribute.value()) == space)
                return true;
        return false;
    });
    for (const pugi::xml_attribute attribute : node.attributes())
        if (std::string_view(attribute.value()) == space && std::string_view(attribute.name()).substr(0, 6) == "xmlns:")
            return std::string(attribute.name()).substr(6) + ':';
    return usual;
}

/// The element that holds a property, as an attribute or as itself.
pugi::xml_node find_property(const pugi::xml_document& document, const std::string& name)
{
    return document.find_node(
        [&](const pugi::xml_node& candidate) { return candidate.attribute(name.c_str()) || name == candidate.name(); });
}

/// The values of a property, which is an attribute, an element, or an element with a sequence of elements.
std::vector<double> values_of(const pugi::xml_document& document, const std::string& name)
{
    std::vector<double> values;
    const pugi::xml_node node = find_property(document, name);
    const auto add = [&](const char* text) {
        char* end = nullptr;
        const double value = std::strtod(text, &end);
        values.push_back(end != text && *end == '\0' ? value : std::numeric_limits<double>::quiet_NaN());
    };
    if (const pugi::xml_attribute attribute = node.attribute(name.c_str()))
        add(attribute.value());
    else if (node && node.first_child().type() == pugi::node_pcdata)
        add(node.child_value());
    else
        for (const pugi::xml_node& entry : node.first_child().children())
            add(entry.child_value());
    return values;
}

/// False where a property is there and is neither one number nor three.
bool read_property(const std::vector<double>& values, double GainChannel::*member, GainMetadata& metadata)
{
    if (values.empty())
        return true;
    if (values.size() != 1 && values.size() != 3)
        return false;
    if (values.size() == 3)
        metadata.channels = 3;
    for (std::size_t c = 0; c < 3; ++c)
        metadata.channel[c].*member = values[values.size() == 3 ? c : 0];
    return true;
}

bool is_hdr_base(const pugi::xml_document& document, const std::string& prefix)
{
    const std::string name = prefix + "BaseRenditionIsHDR";
    const pugi::xml_node node = find_property(document, name);
    const std::string_view value =
        node.attribute(name.c_str()) ? node.attribute(name.c_str()).value() : node.child_value();
    return value == "True" || value == "true";
}

}  // namespace

std::string xmp_gain_metadata(const GainMetadata& metadata)
{
    pugi::xml_document document;
    pugi::xml_node description = add_description(start_packet(document));
    description.append_attribute("hdrgm:BaseRenditionIsHDR") = "False";
    description.append_attribute("hdrgm:HDRCapacityMin") = format("{:.6f}", metadata.base_headroom).c_str();
    description.append_attribute("hdrgm:HDRCapacityMax") = format("{:.6f}", metadata.alternate_headroom).c_str();
    for (std::size_t p = 0; p < std::size(kChannelProperties); ++p)
        description.append_attribute((std::string("hdrgm:") + kChannelProperties[p]).c_str()) =
            format("{:.6f}", metadata.channel[0].*kChannelMembers[p]).c_str();
    return text_of(document);
}

bool parse_xmp_gain_metadata(std::string_view packet, GainMetadata& metadata, std::string& error)
{
    pugi::xml_document document;
    if (!document.load_buffer(packet.data(), packet.size())) {
        error = "the XMP packet of its gain map is damaged";
        return false;
    }
    const std::string prefix = prefix_of(document, kGainMapSpace, "hdrgm:");
    if (is_hdr_base(document, prefix)) {
        error = "its base is the HDR picture and its gain map leads to SDR, expected an SDR base";
        return false;
    }
    const std::vector<double> most = values_of(document, prefix + "HDRCapacityMax");
    const std::vector<double> least = values_of(document, prefix + "HDRCapacityMin");
    bool fine = most.size() == 1 && least.size() <= 1;
    for (std::size_t p = 0; p < std::size(kChannelProperties); ++p)
        fine = fine && read_property(values_of(document, prefix + kChannelProperties[p]), kChannelMembers[p], metadata);
    if (!fine) {
        error =
            "the XMP packet of its gain map lacks HDRCapacityMax, or has a property that is not one number or three";
        return false;
    }
    metadata.alternate_headroom = most[0];
    metadata.base_headroom = least.empty() ? 0.0 : least[0];
    return check_gain_metadata(metadata, error);
}

std::string xmp_with_directory(std::string_view packet, std::size_t gain_map_size)
{
    pugi::xml_document document;
    pugi::xml_node rdf;
    if (!packet.empty() && document.load_buffer(packet.data(), packet.size()) && document.child("x:xmpmeta"))
        rdf = document.find_node([](const pugi::xml_node& node) { return std::string_view(node.name()) == "rdf:RDF"; });
    if (!rdf)
        rdf = start_packet(document);
    pugi::xml_node description = add_description(rdf);
    description.append_attribute("xmlns:Container") = kContainerSpace;
    description.append_attribute("xmlns:Item") = kItemSpace;
    pugi::xml_node items = description.append_child("Container:Directory").append_child("rdf:Seq");
    add_item(items, "Primary", 0);
    add_item(items, "GainMap", gain_map_size);
    return text_of(document);
}

}  // namespace PIMG_ABI
}  // namespace pimg
