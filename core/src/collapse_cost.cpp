// SPDX-License-Identifier: BSD-3-Clause
#include "collapse_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pimg {

namespace {

// Regularisation. Flat and ramp-like places leave the 2 x 2 system singular: a pull to the edge's midpoint
// of 1e-4 of its trace decides there, plus a share of the area for where even the trace vanishes. The cost gets a
// floor that grows with area and length, so that flat places coarsen evenly instead of growing one giant fan.
constexpr float kPullOfTrace = 1e-4f;
constexpr float kPullOfArea = 1e-6f;
constexpr float kCostFloor = 1e-5f;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Number of lanes to compute: a fixed few widths keep the loops vectorised. The
/// result does not depend on it.
int padded(int degree)
{
    return degree <= 8 ? 8 : kLanes;
}

/// Sum of 16 lanes as a fixed tree, so that it is the same whatever the vector width.
float tree_sum(const float* v)
{
    float s[8];
    for (int j = 0; j < 8; ++j)
        s[j] = v[j] + v[j + 8];
    for (int j = 0; j < 4; ++j)
        s[j] += s[j + 4];
    return (s[0] + s[2]) + (s[1] + s[3]);
}

struct Quadric {
    float xx, xy, yy, xz, yz, zz;  // H
    float bx, by, bz, k;           // u H u - 2 b u + k
};

inline Quadric edge_quadric(const EdgeFan& f, int j, int previous)
{
    const float px = f.nx[previous], py = f.ny[previous], pz = f.nz[previous];
    const float qx = f.nx[j], qy = f.ny[j], qz = f.nz[j];
    const float dx = f.dx[j], dy = f.dy[j], dz = f.dz[j];
    Quadric h;
    h.bx = f.a[0][j] * dx + f.a[1][j] * dy + f.a[3][j] * dz;
    h.by = f.a[1][j] * dx + f.a[2][j] * dy + f.a[4][j] * dz;
    h.bz = f.a[3][j] * dx + f.a[4][j] * dy + f.a[5][j] * dz;
    h.k = h.bx * dx + h.by * dy + h.bz * dz;
    h.xx = f.sums.xx + f.a[0][j] - px * px - qx * qx;
    h.xy = f.sums.xy + f.a[1][j] - px * py - qx * qy;
    h.yy = f.sums.yy + f.a[2][j] - py * py - qy * qy;
    h.xz = f.sums.xz + f.a[3][j] - px * pz - qx * qz;
    h.yz = f.sums.yz + f.a[4][j] - py * pz - qy * qz;
    h.zz = f.sums.zz + f.a[5][j] - pz * pz - qz * qz;
    return h;
}

inline float evaluate(const Quadric& h, float x, float y, float z)
{
    return x * (h.xx * x + 2.0f * (h.xy * y + h.xz * z - h.bx)) + y * (h.yy * y + 2.0f * (h.yz * z - h.by))
           + z * (h.zz * z - 2.0f * h.bz) + h.k;
}

}  // namespace

void fan_normals(int degree, const float* dx, const float* dy, const float* dz, const float* real, Normals& n)
{
    // Neighbour j + 1 of every lane, the last one wrapping round.
    alignas(64) float ex[kLanes], ey[kLanes], ez[kLanes], er[kLanes];
    const int lanes = padded(degree);
    for (int j = 0; j + 1 < lanes; ++j) {
        ex[j] = dx[j + 1];
        ey[j] = dy[j + 1];
        ez[j] = dz[j + 1];
        er[j] = real[j + 1];
    }
    ex[degree - 1] = dx[0];
    ey[degree - 1] = dy[0];
    ez[degree - 1] = dz[0];
    er[degree - 1] = real[0];
    for (int j = 0; j < lanes; ++j) {
        const bool triangle = j < degree && real[j] > 0.0f && er[j] > 0.0f;
        n.x[j] = triangle ? dy[j] * ez[j] - dz[j] * ey[j] : 0.0f;
        n.y[j] = triangle ? dz[j] * ex[j] - dx[j] * ez[j] : 0.0f;
        n.z[j] = triangle ? dx[j] * ey[j] - dy[j] * ex[j] : 0.0f;
    }
    for (int j = lanes; j < kLanes; ++j)
        n.x[j] = n.y[j] = n.z[j] = 0.0f;
}

FanSums add_up(int degree, const Normals& n)
{
    alignas(64) float p[9][kLanes];
    const int lanes = padded(degree);
    for (int j = 0; j < lanes; ++j) {
        p[0][j] = n.x[j] * n.x[j];
        p[1][j] = n.x[j] * n.y[j];
        p[2][j] = n.y[j] * n.y[j];
        p[3][j] = n.x[j] * n.z[j];
        p[4][j] = n.y[j] * n.z[j];
        p[5][j] = n.z[j] * n.z[j];
        p[6][j] = n.x[j];
        p[7][j] = n.y[j];
        p[8][j] = n.z[j];
    }
    for (auto& lane : p)
        for (int j = lanes; j < kLanes; ++j)
            lane[j] = 0.0f;
    return { tree_sum(p[0]), tree_sum(p[1]), tree_sum(p[2]), tree_sum(p[3]), tree_sum(p[4]),
             tree_sum(p[5]), tree_sum(p[6]), tree_sum(p[7]), tree_sum(p[8]) };
}

void evaluate_edges(EdgeFan& f)
{
    const int lanes = padded(f.degree);
    for (int j = f.degree; j < lanes; ++j) {
        f.dx[j] = f.dy[j] = f.dz[j] = f.real[j] = f.fixed_x[j] = f.fixed_y[j] = 0.0f;
        for (auto& lane : f.a)
            lane[j] = 0.0f;
        for (auto& lane : f.n)
            lane[j] = 0.0f;
    }
    Normals normals;
    fan_normals(f.degree, f.dx, f.dy, f.dz, f.real, normals);
    std::copy(normals.x, normals.x + kLanes, f.nx);
    std::copy(normals.y, normals.y + kLanes, f.ny);
    std::copy(normals.z, normals.z + kLanes, f.nz);
    f.sums = add_up(f.degree, normals);

    // Triangle j - 1 of every lane: the other one that shares edge j.
    alignas(64) float px[kLanes], py[kLanes], pz[kLanes];
    px[0] = f.nx[f.degree - 1];
    py[0] = f.ny[f.degree - 1];
    pz[0] = f.nz[f.degree - 1];
    for (int j = 1; j < lanes; ++j) {
        px[j] = f.nx[j - 1];
        py[j] = f.ny[j - 1];
        pz[j] = f.nz[j - 1];
    }
    const float centre_x = f.side & kFixedX ? 1.0f : 0.0f, centre_y = f.side & kFixedY ? 1.0f : 0.0f;
    const FanSums own = f.sums;

    for (int j = 0; j < lanes; ++j) {
        const float dx = f.dx[j], dy = f.dy[j], dz = f.dz[j];
        const float bx = f.a[0][j] * dx + f.a[1][j] * dy + f.a[3][j] * dz;
        const float by = f.a[1][j] * dx + f.a[2][j] * dy + f.a[4][j] * dz;
        const float bz = f.a[3][j] * dx + f.a[4][j] * dy + f.a[5][j] * dz;
        const float k = bx * dx + by * dy + bz * dz;
        const float xx = own.xx + f.a[0][j] - px[j] * px[j] - f.nx[j] * f.nx[j];
        const float xy = own.xy + f.a[1][j] - px[j] * py[j] - f.nx[j] * f.ny[j];
        const float yy = own.yy + f.a[2][j] - py[j] * py[j] - f.ny[j] * f.ny[j];
        const float xz = own.xz + f.a[3][j] - px[j] * pz[j] - f.nx[j] * f.nz[j];
        const float yz = own.yz + f.a[4][j] - py[j] * pz[j] - f.ny[j] * f.nz[j];
        const float zz = own.zz + f.a[5][j] - pz[j] * pz[j] - f.nz[j] * f.nz[j];

        // Volume preservation: N . u = N1 . d, hence z = offset - alpha x - beta y.
        const float area = own.z + f.n[2][j] - pz[j] - f.nz[j];
        const float inverse = f.real[j] / std::max(area, 1e-20f);
        const float alpha = (own.x + f.n[0][j] - px[j] - f.nx[j]) * inverse;
        const float beta = (own.y + f.n[1][j] - py[j] - f.ny[j]) * inverse;
        const float offset = (f.n[0][j] * dx + f.n[1][j] * dy + f.n[2][j] * dz) * inverse;

        // The 2 x 2 system left for (x, y), pulled a little to the midpoint.
        float gxx = xx - 2.0f * alpha * xz + alpha * alpha * zz;
        const float gxy = xy - alpha * yz - beta * xz + alpha * beta * zz;
        float gyy = yy - 2.0f * beta * yz + beta * beta * zz;
        float rx = bx - alpha * bz - offset * (xz - alpha * zz);
        float ry = by - beta * bz - offset * (yz - beta * zz);
        const float pull = kPullOfTrace * (gxx + gyy) + kPullOfArea * area * area;
        gxx += pull;
        gyy += pull;
        rx += pull * 0.5f * dx;
        ry += pull * 0.5f * dy;
        const float det = std::max(gxx * gyy - gxy * gxy, 1e-30f);
        const float free_x = (rx * gyy - ry * gxy) / det;
        const float free_y = (ry * gxx - rx * gxy) / det;

        // Border ends keep to their side; the other coordinate stays free.
        const float fx = std::max(centre_x, f.fixed_x[j]), fy = std::max(centre_y, f.fixed_y[j]);
        const float side_x = f.fixed_x[j] * (1.0f - centre_x) * dx, side_y = f.fixed_y[j] * (1.0f - centre_y) * dy;
        const float slide_x = (rx - gxy * side_y) / std::max(gxx, 1e-30f);
        const float slide_y = (ry - gxy * side_x) / std::max(gyy, 1e-30f);
        const float x = fx > 0.0f ? side_x : (fy > 0.0f ? slide_x : free_x);
        const float y = fy > 0.0f ? side_y : (fx > 0.0f ? slide_y : free_y);
        const float z = offset - alpha * x - beta * y;

        const float volume = x * (xx * x + 2.0f * (xy * y + xz * z - bx)) + y * (yy * y + 2.0f * (yz * z - by))
                             + z * (zz * z - 2.0f * bz) + k;
        const float floor = kCostFloor * area * (dx * dx + dy * dy);
        f.x[j] = x;
        f.y[j] = y;
        f.alpha[j] = alpha;
        f.beta[j] = beta;
        f.offset[j] = offset;
        f.cost[j] = f.real[j] > 0.0f ? std::max(volume, 0.0f) + floor : kInfinity;
    }
}

float cost_at(const EdgeFan& f, int j, float x, float y)
{
    const Quadric h = edge_quadric(f, j, j > 0 ? j - 1 : f.degree - 1);
    const float z = f.offset[j] - f.alpha[j] * x - f.beta[j] * y;
    const float area = f.sums.z + f.n[2][j] - f.nz[j > 0 ? j - 1 : f.degree - 1] - f.nz[j];
    return std::max(evaluate(h, x, y, z), 0.0f) + kCostFloor * area * (f.dx[j] * f.dx[j] + f.dy[j] * f.dy[j]);
}

}  // namespace pimg
