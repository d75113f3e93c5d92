// SPDX-License-Identifier: BSD-3-Clause
// Figure 12 and Table 2 of the paper for any pictures: what an adaptive initial mesh leaves, and what it saves.
//     adaptive_figure [-density D] [-control gradient|curvature] [-o FOLDER] PICTURE...
// prints a row for each; with -o also writes control map, samples, mesh and Gouraud image beside each other.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>

#include <pimg/rasterize.h>
#include <pimg/sampling.h>
#include <pimg/simplify.h>

namespace {

struct Settings {
    pimg::SamplingOptions sampling;
    std::string folder;
};

double cpu_seconds()
{
    return double(std::clock()) / CLOCKS_PER_SEC;
}

/// Channels of an 8-bit picture, 0..255, and its luma.
struct Channels {
    int width = 0, height = 0;
    std::vector<std::vector<float>> colour;
    std::vector<float> luma;
};

bool read(const std::string& filename, Channels& picture)
{
    OIIO::ImageBuf file(filename);
    if (!file.read(0, 0, true, OIIO::TypeDesc::FLOAT))
        return false;
    const OIIO::ImageSpec& spec = file.spec();
    picture.width = spec.width;
    picture.height = spec.height;
    picture.colour.resize(spec.nchannels < 3 ? 1 : 3);
    constexpr float kWeights[3] = { 0.2126f, 0.7152f, 0.0722f };
    const float* p = static_cast<const float*>(file.localpixels());
    for (std::size_t i = 0; i < spec.image_pixels(); ++i, p += spec.nchannels) {
        float luma = 0.0f;
        for (std::size_t c = 0; c < picture.colour.size(); ++c) {
            picture.colour[c].push_back(255.0f * p[c]);
            luma += (picture.colour.size() > 1 ? kWeights[c] : 1.0f) * 255.0f * p[c];
        }
        picture.luma.push_back(luma);
    }
    return true;
}

double mean_difference(const std::vector<float>& a, const std::vector<float>& b)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += double(std::fabs(a[i] - b[i]));
    return sum / double(a.size());
}

/// Gouraud image of the finest mesh: the picture less its residual.
std::vector<float> gouraud(const std::vector<float>& samples, const pimg::Bands& bands)
{
    std::vector<float> image = samples;
    for (std::size_t i = 0; i < bands.residual.size(); ++i)
        image[i] -= bands.residual[i];
    return image;
}

/// Seconds of CPU time, the least of three runs.
template<class Work>
double least_seconds(Work&& work)
{
    double least = 1e30;
    for (int i = 0; i < 3; ++i) {
        const double start = cpu_seconds();
        work();
        least = std::min(least, cpu_seconds() - start);
    }
    return least;
}

void write_panels(const std::string& filename, const pimg::Guide& guide, const Settings& settings,
                  const pimg::InitialMesh& initial, const pimg::Hierarchy& hierarchy, const std::vector<float>& image)
{
    const std::size_t w = std::size_t(guide.width), h = std::size_t(guide.height);
    std::vector<float> density = pimg::control_map(guide, settings.sampling.control);
    pimg::to_density(density, settings.sampling.density);
    std::vector<float> samples(w * h, 1.0f);
    for (pimg::Index p : initial.pixels)
        samples[p] = 0.0f;
    pimg::Mesh mesh;
    if (!pimg::refine(hierarchy, hierarchy.levels(), mesh))
        return;
    constexpr std::size_t kScale = 4;  // the mesh is finer than pixels can show: its middle, enlarged
    const std::vector<float> lines = pimg::wireframe(mesh, 1.0f, int(kScale));

    OIIO::ImageSpec spec(int(4 * w), int(h), 1, OIIO::TypeDesc::UINT8);
    std::vector<float> row(4 * w);
    const auto out = OIIO::ImageOutput::create(filename);
    if (!out || !out->open(filename, spec))
        return;
    for (std::size_t y = 0; y < h; ++y) {
        const std::size_t fine_y = h * kScale / 2 - h / 2 + y, fine_x = w * kScale / 2 - w / 2;
        for (std::size_t x = 0; x < w; ++x) {
            row[x] = 1.0f - density[y * w + x];
            row[w + x] = samples[y * w + x];
            row[2 * w + x] = 1.0f - lines[fine_y * w * kScale + fine_x + x];
            row[3 * w + x] = std::clamp(image[y * w + x] / 255.0f, 0.0f, 1.0f);
        }
        out->write_scanline(int(y), 0, OIIO::TypeDesc::FLOAT, row.data());
    }
    out->close();
}

bool measure(const std::string& filename, const Settings& settings)
{
    Channels picture;
    if (!read(filename, picture)) {
        std::fprintf(stderr, "%s: cannot be read\n", filename.c_str());
        return false;
    }
    const pimg::Guide guide { picture.width, picture.height, { { picture.luma.data() } } };
    pimg::Hierarchy hierarchy;
    std::vector<pimg::Bands> bands;
    const double full = least_seconds([&] { pimg::simplify(guide, {}, hierarchy, bands); });
    pimg::InitialMesh initial;
    const double sampling = least_seconds([&] { pimg::sample(guide, settings.sampling, initial); });
    const double rest = least_seconds([&] {
        pimg::SimplifyOptions options;
        options.start = initial;
        pimg::simplify(guide, std::move(options), hierarchy, bands);
    });
    std::vector<const float*> channels;
    for (const std::vector<float>& c : picture.colour)
        channels.push_back(c.data());
    std::vector<pimg::Bands> colour;
    if (!pimg::analyse(hierarchy, channels, colour))
        return false;
    double of_colour = 0.0;
    for (std::size_t c = 0; c < colour.size(); ++c)
        of_colour += mean_difference(gouraud(picture.colour[c], colour[c]), picture.colour[c]) / double(colour.size());
    const std::vector<float> image = gouraud(picture.luma, bands[0]);
    const std::string name = filename.substr(filename.find_last_of('/') + 1);
    std::printf("| %s | %.4f | %.2f | %.2f | %.3f | %.3f | %.2f |\n", name.c_str(),
                double(initial.vertices()) / double(picture.luma.size()), mean_difference(image, picture.luma),
                of_colour, full, sampling + rest, full / (sampling + rest));
    std::fflush(stdout);
    if (!settings.folder.empty())
        write_panels(settings.folder + "/" + name.substr(0, name.find('.')) + "_adaptive.png", guide, settings, initial,
                     hierarchy, image);
    return true;
}

}  // namespace

int main(int argc, char** argv)
{
    Settings settings;
    int i = 1;
    for (; i + 1 < argc && argv[i][0] == '-'; i += 2) {
        if (std::strcmp(argv[i], "-density") == 0)
            settings.sampling.density = std::atof(argv[i + 1]);
        else if (std::strcmp(argv[i], "-control") == 0)
            settings.sampling.control =
                std::strcmp(argv[i + 1], "curvature") == 0 ? pimg::Control::curvature : pimg::Control::gradient;
        else if (std::strcmp(argv[i], "-o") == 0)
            settings.folder = argv[i + 1];
    }
    std::printf("| picture | kept | difference, luma | difference, RGB | all pixels, s | adaptive, s | faster |\n");
    std::printf("|---|---|---|---|---|---|---|\n");
    bool ok = i < argc;
    for (; i < argc; ++i)
        ok = measure(argv[i], settings) && ok;
    return ok ? 0 : 1;
}
