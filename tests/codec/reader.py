#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""An independent .pimg reader, written from docs/format.md alone: plain, slow, complete.

    reader.py FILE...          one line per file: size, channels, hash
    reader.py -o OUT FILE      the samples as they are in memory, packed pixels
    reader.py --cut N FILE     reads the first N bytes only

Python 3 and its standard library; files that use zstd need the module `zstandard` (Debian: python3-zstandard).
Exit code 1 and one line on standard error for a file that is not right.
"""
import argparse
import struct
import sys
import zlib

GHOST = 0xffffffff
TYPES = [('uint8', 1), ('uint16', 2), ('uint32', 4), ('half', 2), ('float', 4)]


class Bad(Exception):
    pass


def need(condition, what):
    if not condition:
        raise Bad(what)


def unzstd(data, size):
    try:
        import zstandard
    except ImportError:
        raise Bad('this file needs the Python module zstandard')
    try:
        out = zstandard.ZstdDecompressor().decompress(data, max_output_size=size)
    except zstandard.ZstdError as error:
        raise Bad('zstd: %s' % error)
    need(len(out) == size, 'zstd: wrong size')
    return out


class Reader:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, n):
        need(n <= len(self.data) - self.at, 'chunk too short')
        self.at += n
        return self.data[self.at - n:self.at]

    def get(self, form):
        values = struct.unpack('<' + form, self.take(struct.calcsize('<' + form)))
        return values[0] if len(values) == 1 else values

    def varint(self):
        v = 0
        for shift in range(0, 63, 7):
            byte = self.get('B')
            v |= (byte & 127) << shift
            if byte < 128:
                return v
        raise Bad('varint too long')

    def rest(self):
        return self.take(len(self.data) - self.at)

    def end(self):
        need(self.at == len(self.data), 'bytes left over')


def unfold(v):
    return v >> 1 if v % 2 == 0 else -(v >> 1) - 1


def wrap(v):
    return (v + 0x80000000 & 0xffffffff) - 0x80000000


# ------------------------------------------------------------------------------------------------------- 3.1 binary coder

class Number:
    def __init__(self):
        self.length = [[16384, 0] for _ in range(64)]
        self.high = [[[16384, 0] for _ in range(4)] for _ in range(33)]


class Binary:
    def __init__(self, data):
        self.data, self.at, self.over = data, 0, 0
        self.range, self.code = 0xffffffff, 0
        for _ in range(4):
            self.code = self.code << 8 | self.byte()

    def byte(self):
        if self.at < len(self.data):
            self.at += 1
            return self.data[self.at - 1]
        self.over += 1
        need(self.over <= 4, 'coded bits run out')
        return 0

    def fill(self):
        while self.range < 1 << 24:
            self.range = self.range << 8
            self.code = (self.code << 8 | self.byte()) & 0xffffffff

    def bit(self, model):
        bound = (self.range >> 15) * model[0]
        shift = 3 if model[1] < 4 else 4 if model[1] < 16 else 5
        if self.code < bound:
            bit = 0
            self.range = bound
            model[0] += (32768 - model[0]) >> shift
        else:
            bit = 1
            self.code -= bound
            self.range -= bound
            model[0] -= model[0] >> shift
        model[1] = min(16, model[1] + 1)
        self.fill()
        return bit

    def direct(self, count):
        v = 0
        for _ in range(count):
            self.range >>= 1
            one = self.code >= self.range
            if one:
                self.code -= self.range
            v = v << 1 | one
            self.fill()
        return v

    def number(self, model):
        node = 1
        for _ in range(6):
            node = node << 1 | self.bit(model.length[node])
        length = min(32, node & 63)
        if length == 0:
            return 0
        v = 1
        for _ in range(min(2, length - 1)):
            v = v << 1 | self.bit(model.high[length][v])
        if length > 3:
            v = v << (length - 3) | self.direct(length - 3)
        return v

    def signed(self, model):
        return unfold(self.number(model))


# ------------------------------------------------------------------------------------------------------- 3.2 symbol coder

def class_of(v):
    if v < 4:
        return v
    n = v.bit_length() - 1
    return 2 * n + (v >> (n - 1) & 1)


class Symbols:
    def __init__(self, r):
        tables, words, raw = r.varint(), r.varint(), r.varint()
        self.read_tables(Binary(r.take(tables)))
        self.state = list(r.get('II'))
        need(min(self.state) >= 65536, 'state too small')
        self.words = struct.unpack('<%dH' % words, r.take(2 * words))
        self.at = 0
        self.raw_left = 8 * raw
        self.raw = int.from_bytes(r.take(raw), 'little')
        self.raw_at = 0

    def read_tables(self, b):
        models = [Number() for _ in range(13)]
        contexts = b.direct(5)
        need(1 <= contexts <= 24, 'number of contexts')
        self.context_of, self.tables = [], []
        for i in range(contexts):
            last = b.direct(7) if i + 1 < contexts else 95
            need(len(self.context_of) <= last < 96, 'classes')
            self.context_of += [i] * (last + 1 - len(self.context_of))
            used = b.direct(7)
            need(1 <= used <= 72, 'number of tokens')
            before = total = 0
            slots = []
            for t in range(used):
                f = b.number(models[before.bit_length()]) if t + 1 < used else 2048 - total
                need(f <= 2048 - total, 'frequencies')
                slots += [(t, f, total)] * f
                total += f
                before = f
            self.tables.append(slots)

    def next(self, klass):
        state = self.state[0]
        slot = state & 2047
        t, f, start = self.tables[self.context_of[klass]][slot]
        x = f * (state >> 11) + slot - start
        if x < 65536:
            need(self.at < len(self.words), 'words run out')
            x = x << 16 | self.words[self.at]
            self.at += 1
        self.state = [self.state[1], x]
        if t < 16:
            return t
        e = (t - 16) // 2 + 3
        need(self.raw_at + e <= self.raw_left, 'raw bits run out')
        v = (2 + (t & 1)) << e | (self.raw >> self.raw_at & ((1 << e) - 1))
        self.raw_at += e
        return v

    def end(self):
        need(self.at == len(self.words) and self.state == [65536, 65536] and self.raw_left - self.raw_at < 8,
             'symbols left over')


# --------------------------------------------------------------------------------------------------------- 5. mesh layer

def area(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])


class Layer:
    def __init__(self, width, height, channels):
        self.extent = (64 * (max(2, width) - 1), 64 * (max(2, height) - 1))
        self.values = [[] for _ in range(channels)]
        self.points, self.rings, self.touched = [], [], []
        self.batch = 0

    def read_base(self, data):
        r = Reader(data)
        self.lattice = r.get('B')
        need(self.lattice <= 6, 'lattice')
        self.shifts = list(r.take(len(self.values)))
        need(max(self.shifts) <= 17, 'shift')
        n, triangles = r.varint(), r.varint()
        need(4 <= n <= 65536 and triangles <= 2 * n, 'size of the base mesh')
        b = Binary(r.rest())
        mx, my, m1, m2, m3 = (Number() for _ in range(5))
        x = y = 0
        for _ in range(n):
            x += b.signed(mx)
            y += b.signed(my)
            need(0 <= x <= self.extent[0] and 0 <= y <= self.extent[1], 'vertex outside')
            self.points.append((x, y))
        follows = [{} for _ in range(n)]
        v = total = 0
        for _ in range(triangles):
            v += b.number(m1)
            t = (v, v + b.number(m2), v + b.number(m3))
            need(max(t) < n and len(set(t)) == 3, 'triangle')
            s = area(*(self.points[k] for k in t))
            need(s > 0, 'flipped triangle')
            total += s
            for k in range(3):
                need(t[(k + 1) % 3] not in follows[t[k]], 'edge of three triangles')
                follows[t[k]][t[(k + 1) % 3]] = t[(k + 2) % 3]
        need(total == 2 * self.extent[0] * self.extent[1], 'the base mesh does not cover the picture')
        for around in follows:
            starts = set(around) - set(around.values())
            need(around and len(starts) <= 1, 'broken fan')
            ring = [min(starts) if starts else min(around)]
            while ring[-1] in around and around[ring[-1]] != ring[0] and len(ring) <= len(around):
                ring.append(around[ring[-1]])
            need(len(ring) == len(around) + len(starts), 'broken fan')
            self.rings.append(ring + [GHOST] * len(starts))
            need(3 <= len(self.rings[-1]) <= 16, 'ring')
        for z, _ in zip(self.values, self.shifts):
            model, last = Number(), 0
            for _ in range(n):
                last += b.signed(model)
                need(-131072 <= last <= 131071, 'value')
                z.append(last)
        self.touched = [0] * n
        self.flag = [[16384, 0] for _ in range(64)]
        self.vr = [Number() for _ in range(17)]
        self.vl = [Number() for _ in range(17)]
        self.edge = [[Number() for _ in range(64)] for _ in range(2)]
        self.middle = [[Number() for _ in range(64)] for _ in range(2)]
        self.detail = [[[Number() for _ in range(4)] for _ in range(2)] for _ in self.values]

    def ring(self, v):
        ring = self.rings[v]
        k = ring.index(min(ring))
        return ring[k:] + ring[:k]

    def radius(self, v, ring):
        p = self.points[v]
        return max(max(abs(self.points[q][0] - p[0]), abs(self.points[q][1] - p[1])) for q in ring if q != GHOST)

    def read_batches(self, data, most):
        r = Reader(data)
        before, after, batches = r.varint(), r.varint(), r.varint()
        need(before == len(self.points) and before <= after <= most, 'batch does not continue')
        b = Binary(r.rest())
        for _ in range(batches):
            self.batch += 1
            vertices = len(self.points)
            for v in range(vertices):
                ring = self.ring(v)
                size = min(31, (self.radius(v, ring) >> self.lattice).bit_length())
                touched = self.batch > 1 and self.touched[v] + 1 >= self.batch
                if b.bit(self.flag[2 * size + touched]):
                    need(len(self.points) < after, 'too many splits')
                    self.split(b, v, ring)
            need((len(self.points) - vertices) * 256 >= vertices, 'empty batch')
        need(len(self.points) == after, 'splits are missing')

    def split(self, b, s, ring):
        d, sh, p = len(ring), self.lattice, self.points[s]
        vr = b.number(self.vr[d])
        steps = b.number(self.vl[d])
        need(vr < d and 1 <= steps < d, 'cut vertex')
        ring = ring[vr:] + ring[:vr]       # from vr on
        border = int(GHOST in ring)
        k = (self.radius(s, ring) >> sh).bit_length()
        e = [b.signed(self.edge[border][2 * k + i]) for i in (0, 1)]
        need(max(abs(e[0]), abs(e[1])) < 1 << 28, 'edge')
        length = max(abs(e[0]), abs(e[1])).bit_length()
        m = [b.signed(self.middle[border][2 * length + i]) for i in (0, 1)]
        t = [((p[i] + (1 << sh >> 1)) >> sh) - (e[i] >> 1) + m[i] for i in (0, 1)]
        u = [t[i] + e[i] for i in (0, 1)]
        t, u = tuple(c << sh for c in t), tuple(c << sh for c in u)
        self.check_fan(t, ring[:steps + 1], u)
        self.check_fan(u, ring[steps:] + ring[:1], t)
        corner = all(p[i] in (0, self.extent[i]) for i in (0, 1))
        need(not corner or p in (t, u), 'corner moved')
        new = len(self.points)
        f = [None, None]
        stencils = [self.stencil(s, ring, q) for q in (t, u)]
        for c, z in enumerate(self.values):
            fine = []
            for j in (0, 1):
                a, bb, wa, wb = stencils[j]
                guess = z[s] + ((wa * (z[a] - z[s]) + wb * (z[bb] - z[s])) >> 16)
                q = 0 if c == 0 else min(3, f[j].bit_length() // 2)
                f[j] = b.number(self.detail[c][j][q])
                fine.append(max(-131072, min(131071, guess + unfold(f[j]) * (1 << self.shifts[c]))))
            z[s] = fine[0]
            z.append(fine[1])
        vl, vr = ring[steps], ring[0]
        need(steps + 2 <= 16 and d - steps + 2 <= 16, 'ring too large')
        for q in ring[steps + 1:]:
            if q != GHOST:
                self.rings[q] = [new if x == s else x for x in self.rings[q]]
        for q, pair in ((vl, [new, s]), (vr, [s, new])):
            if q != GHOST:
                i = self.rings[q].index(s)
                self.rings[q][i:i + 1] = pair
                need(len(self.rings[q]) <= 16, 'ring too large')
        self.rings[s] = ring[:steps + 1] + [new]
        self.rings.append(ring[steps:] + ring[:1] + [s])
        self.points[s] = t
        self.points.append(u)
        self.touched.append(self.batch)
        for q in ring + [s]:
            if q != GHOST:
                self.touched[q] = self.batch

    def stencil(self, s, ring, p):
        origin = self.points[s]
        for i, a in enumerate(ring):
            b = ring[(i + 1) % len(ring)]
            if GHOST in (a, b):
                continue
            upper = area(origin, self.points[a], p)
            lower = area(origin, p, self.points[b])
            if lower < 0 or upper < 0:
                continue
            whole = area(origin, self.points[a], self.points[b])
            while whole >= 1 << 46:
                whole, lower, upper = whole >> 1, lower >> 1, upper >> 1
            return a, b, min(65536, 65536 * lower // whole), min(65536, 65536 * upper // whole)
        return s, s, 0, 0

    def check_fan(self, p, path, other):
        need(all(0 <= p[i] <= self.extent[i] for i in (0, 1)), 'vertex outside')
        corners = [None if q == GHOST else self.points[q] for q in path] + [other]
        for i, a in enumerate(corners):
            b = corners[(i + 1) % len(corners)]
            if a is None or b is None:
                q = a or b
                need(q and any(p[k] == q[k] and p[k] in (0, self.extent[k]) for k in (0, 1)), 'border leaves its side')
            else:
                need(area(p, a, b) > 0, 'flipped triangle')
        if None not in corners:
            need(all(0 < p[k] < self.extent[k] for k in (0, 1)), 'inner vertex on a side')

    def show(self, c, width, height, shift):
        """Values of channel c at every pixel, as a list of rows."""
        triangles = []
        for v, ring in enumerate(self.rings):
            for i, a in enumerate(ring):
                b = ring[(i + 1) % len(ring)]
                if GHOST not in (a, b) and v < a and v < b:
                    triangles.append((v, a, b))
        crossed = sum((max(self.points[k][1] for k in t) - min(self.points[k][1] for k in t)) // 64 + 1 for t in triangles)
        need(crossed <= 16 * width * height + 8 * len(triangles) + 65536, 'triangles too thin')
        out = [[0] * width for _ in range(height)]
        for t in sorted(triangles):
            p = [self.points[k] for k in t]
            a, b, d = (self.values[c][k] for k in t)
            whole = area(*p)
            x1, y1, x2, y2 = p[1][0] - p[0][0], p[1][1] - p[0][1], p[2][0] - p[0][0], p[2][1] - p[0][1]
            steep = 1 << 34
            gx = max(-steep, min(steep, ((b - a) * y2 - (d - a) * y1) * 65536 // whole))
            gy = max(-steep, min(steep, ((d - a) * x1 - (b - a) * x2) * 65536 // whole))
            start = 1024 * a - (gx * p[0][0] + gy * p[0][1]) // 64
            low, high = min(a, b, d), max(a, b, d)
            xs, ys = [q[0] for q in p], [q[1] for q in p]
            for y in range(-(-min(ys) // 64), min(height - 1, max(ys) // 64) + 1):
                for x in range(-(-min(xs) // 64), min(width - 1, max(xs) // 64) + 1):
                    q = (64 * x, 64 * y)
                    if area(p[0], p[1], q) >= 0 and area(p[1], p[2], q) >= 0 and area(p[2], p[0], q) >= 0:
                        out[y][x] = max(low, min(high, (start + gx * x + gy * y) >> 10)) << shift
        return out


# -------------------------------------------------------------------------------------------------------- 6. raster tiles

def read_plane(r, width, height, mesh, before):
    """One channel of a tile: rows of integers, and the sizes of the residuals."""
    head = r.get('B')
    shape, gouraud, method = head & 3, head & 4, head >> 4
    need(method <= 1 and not head & 8, 'method')
    if method == 0:
        symbols = Symbols(r)
    else:
        planes = r.get('B')
        need(1 <= planes <= 4, 'planes')
        n = width * height
        raw = unzstd(r.take(r.varint()), planes * n)
    rows, sizes = [], []
    for y in range(height):
        rows.append([0] * width)
        sizes.append([0] * width)
        for x in range(width):
            def d(i, j):
                return rows[j][i] - (mesh[j][i] if gouraud else 0)
            if y == 0:
                w = d(x - 1, 0) if x else 0
                n_ = nw = ne = w
                busy = 4 * sizes[0][x - 2] if x > 1 else 0
            else:
                right = min(x + 1, width - 1)
                n_, ne = d(x, y - 1), d(right, y - 1)
                w, nw = (d(x - 1, y), d(x - 1, y - 1)) if x else (n_, n_)
                ww, eww = (d(x - 2, y), sizes[y][x - 2]) if x > 1 else (nw, sizes[y - 1][0])
                busy = abs(ww - nw) + abs(n_ - nw) + abs(n_ - ne) + eww + 2 * sizes[y - 1][x] + sizes[y - 1][right]
            if before:
                busy += 2 * before[y][x]
            if method == 0:
                v = symbols.next(class_of(min(0xffffffff, busy)))
            else:
                v = sum(raw[k * n + y * width + x] << (8 * k) for k in range(planes))
            if shape == 0:
                guess = 0
            elif shape == 1:
                guess = w
            elif shape == 2:
                guess = max(min(w, n_), min(max(w, n_), w + n_ - nw))
            else:
                guess = (6 * w + 5 * n_ - 4 * nw + ne + 4) >> 3
            rows[y][x] = wrap(guess + (mesh[y][x] if gouraud else 0) + unfold(v))
            sizes[y][x] = min(65535, (v + 1) // 2)
    if method == 0:
        symbols.end()
    return rows, sizes


# ------------------------------------------------------------------------------------------------------------- 4. samples

def untransform(transform, planes):
    for y, row in enumerate(planes[0]):
        for x, first in enumerate(row):
            second, third = planes[1][y][x], planes[2][y][x]
            if transform == 1:
                t = first - (second >> 1)
                blue = t - (third >> 1)
                rgb = blue + third, second + t, blue
            else:
                rgb = third + first, first, second + first
            for c in range(3):
                planes[c][y][x] = wrap(rgb[c])


def to_bits(kind, v):
    if kind == 2:
        return (v & 0xffffffff) ^ 0x80000000
    if kind == 3:
        v &= 0xffff
        return v ^ 0x7fff if v & 0x8000 else v
    if kind == 4:
        v &= 0xffffffff
        return v ^ 0x7fffffff if v & 0x80000000 else v
    return v & (0xff if kind == 0 else 0xffff)


RANGE = [(0, 255), (0, 65535), (-2**31, 2**31 - 1), (-1 - 0x7bff, 0x7bff), (-1 - 0x7f7fffff, 0x7f7fffff)]


def xxh64(data):
    p1, p2, p3, p4, p5 = (0x9e3779b185ebca87, 0xc2b2ae3d27d4eb4f, 0x165667b19e3779f9, 0x85ebca77c2b2ae63,
                          0x27d4eb2f165667c5)
    mask = (1 << 64) - 1

    def rotate(v, n):
        return (v << n | v >> (64 - n)) & mask

    def one(lane, v):
        return rotate((lane + v * p2) & mask, 31) * p1 & mask
    at = 0
    if len(data) >= 32:
        lanes = [(p1 + p2) & mask, p2, 0, -p1 & mask]
        while at + 32 <= len(data):
            for k, v in enumerate(struct.unpack_from('<4Q', data, at)):
                lanes[k] = one(lanes[k], v)
            at += 32
        h = sum(rotate(v, n) for v, n in zip(lanes, (1, 7, 12, 18))) & mask
        for v in lanes:
            h = ((h ^ one(0, v)) * p1 + p4) & mask
    else:
        h = p5
    h = (h + len(data)) & mask
    while at + 8 <= len(data):
        h = (rotate(h ^ one(0, struct.unpack_from('<Q', data, at)[0]), 27) * p1 + p4) & mask
        at += 8
    if at + 4 <= len(data):
        h = (rotate(h ^ struct.unpack_from('<I', data, at)[0] * p1 & mask, 23) * p2 + p3) & mask
        at += 4
    for byte in data[at:]:
        h = rotate(h ^ byte * p5 & mask, 11) * p1 & mask
    h = (h ^ h >> 33) * p2 & mask
    h = (h ^ h >> 29) * p3 & mask
    return h ^ h >> 32


# -------------------------------------------------------------------------------------------------------------- the file

class Picture:
    pass


def chunks(data):
    need(data[:8] == b'\x8aPIM\r\n\x1a\n', 'not a pimg file')
    at = 8
    while at + 20 <= len(data):
        kind, flags, version, length = struct.unpack_from('<4sHHQ', data, at)
        need(kind.isalpha(), 'no chunk at byte %d' % at)
        need(version == 0 or not flags & 1, 'chunk version')
        if length > len(data) - at - 20:
            return
        end = at + 16 + length
        need(zlib.crc32(data[at:end]) == struct.unpack_from('<I', data, end)[0], 'chunk %s is damaged' % kind.decode())
        yield kind.decode(), flags, data[at + 16:end]
        if kind == b'DONE':
            return
        at = end + 4


def read_attributes(data):
    r = Reader(data)
    method, size = r.get('B'), r.varint()
    need(method <= 1, 'attributes')
    need(method == 0 or size <= 2**22 + 64 * (len(data) - r.at), 'attributes unpack to too much')
    body = unzstd(r.rest(), size) if method else r.rest()
    need(len(body) == size, 'attributes')
    r = Reader(body)
    found = []
    for _ in range(r.varint()):
        found.append(tuple(r.take(r.varint()) for _ in range(3)))
    r.end()
    return found


def read(data):
    p = Picture()
    p.attributes, tiles, layer, seen, done = [], [], None, [], False
    for kind, flags, body in chunks(data):
        need((kind == 'HEAD') == (not seen), 'HEAD is not first')
        if kind == 'HEAD':
            r = Reader(body)
            (p.major, p.minor, p.profile, p.transform, p.tile, p.x, p.y, p.width, p.height) = r.get('HHBBHiiII')
            p.display = r.get('iiII')
            p.channels, p.vertices, p.hash = r.get('IIQ')
            need(p.major == 1 and p.profile <= 1 and p.transform <= 2 and 16 <= p.tile <= 1024, 'header')
            need(1 <= p.width <= 2**20 and 1 <= p.height <= 2**20 and p.width * p.height <= 2**31, 'size')
            need(1 <= p.channels <= 1024, 'channels')
            p.most = min(p.vertices, max(2, p.width) * max(2, p.height))
            columns, rows = -(-p.width // p.tile), -(-p.height // p.tile)
        elif kind == 'CHAN':
            need(seen == ['HEAD'], 'CHAN is misplaced')
            r = Reader(body)
            p.names, p.types = [], []
            for _ in range(p.channels):
                p.types.append(r.get('B'))
                need(p.types[-1] < 5, 'sample type')
                p.names.append(r.take(r.get('B')).decode('utf-8', 'replace'))
            r.end()
            need(p.transform == 0 or (len(set(p.types[:3])) == 1 and p.channels >= 3 and TYPES[p.types[0]][1] <= 2),
                 'transform')
        elif kind == 'META':
            need(seen[-1] == 'CHAN', 'META is misplaced')
            p.attributes = read_attributes(body)
        elif kind == 'MESH':
            need('CHAN' in seen and 'MESH' not in seen, 'MESH is misplaced')
            layer = Layer(p.width, p.height, p.channels)
            layer.read_base(body)
            need(len(layer.points) <= p.most, 'base mesh')
        elif kind == 'BATC':
            need(layer and not tiles, 'BATC is misplaced')
            layer.read_batches(body, p.most)
        elif kind == 'RAST':
            need(layer and 'COLL' not in seen and len(tiles) < columns * rows, 'RAST is misplaced')
            need(struct.unpack_from('<I', body)[0] == len(tiles), 'tile number')
            tiles.append(body[4:])
        elif kind in ('COLL', 'DONE'):
            need(layer and len(tiles) == columns * rows, kind + ' is misplaced')
            done = kind == 'DONE'
        else:
            need(not flags & 1, 'chunk %s needs a newer reader' % kind)
            continue
        seen.append(kind)
    need('CHAN' in seen and layer, 'the file ends before its first picture')
    p.exact = len(tiles) == columns * rows
    p.complete = done
    shift = [16 if TYPES[t][1] == 4 else 0 for t in p.types]
    shown = [layer.show(c, p.width, p.height, shift[c]) for c in range(p.channels)]
    integers = [[list(row) for row in plane] for plane in shown]
    clamp = [[True] * columns for _ in range(rows)]
    for number, body in enumerate(tiles):
        x0, y0 = number % columns * p.tile, number // columns * p.tile
        x1, y1 = min(p.width, x0 + p.tile), min(p.height, y0 + p.tile)
        clamp[number // columns][number % columns] = False
        r, before = Reader(body), None
        for c in range(p.channels):
            mesh = [row[x0:x1] for row in shown[c][y0:y1]]
            plane, before = read_plane(r, x1 - x0, y1 - y0, mesh, before)
            for y, row in enumerate(plane):
                integers[c][y0 + y][x0:x1] = row
        r.end()
    if p.transform:
        untransform(p.transform, integers)
    out = bytearray()
    for y in range(p.height):
        for x in range(p.width):
            for c, kind in enumerate(p.types):
                v = integers[c][y][x]
                if clamp[y // p.tile][x // p.tile]:
                    v = max(RANGE[kind][0], min(RANGE[kind][1], v))
                out += to_bits(kind, v).to_bytes(TYPES[kind][1], 'little')
    p.samples = bytes(out)
    p.found_hash = xxh64(p.samples)
    need(not p.exact or p.hash in (0, p.found_hash), 'the samples are not those that were written (hash)')
    return p


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('files', nargs='+')
    parser.add_argument('-o', dest='output')
    parser.add_argument('--cut', type=int)
    args = parser.parse_args()
    failed = 0
    for name in args.files:
        try:
            with open(name, 'rb') as f:
                p = read(f.read() if args.cut is None else f.read(args.cut))
        except Bad as error:
            print('%s: %s' % (name, error), file=sys.stderr)
            failed = 1
            continue
        kinds = ','.join('%s:%s' % (n, TYPES[t][0]) for n, t in zip(p.names, p.types))
        print('%s: %d x %d %s %d attributes %s xxh64 %016x' % (name, p.width, p.height, kinds, len(p.attributes),
                                                               'exact' if p.exact else 'coarse', p.found_hash))
        if args.output:
            with open(args.output, 'wb') as f:
                f.write(p.samples)
    return failed


if __name__ == '__main__':
    sys.exit(main())
