"""A Sahl scene, as `sahl convert` writes it, as a POV-Ray 3.7 scene of the same image.

Coordinates stay as they are: POV-Ray's camera takes any three vectors, so that its being left-handed does not show. What
POV-Ray cannot do, or does by other rules, is Unconvertible. Its manual is what this follows (sections on finish, interior
and light sources).
"""

import math

# Beside a diffuse colour of 0: POV-Ray multiplies everything but mirrors and highlights by the pigment.
LEAST_PIGMENT = 1e-6
# To where directional lights stand; POV-Ray's scenes end at 1e7.
FAR = 1e6


class Unconvertible(Exception):
    """Names what POV-Ray does not have."""


def color(value):
    return value if isinstance(value, list) else [value] * 3


def vector(values, digits=9):
    return "<" + ",".join(f"{value:.{digits}g}" for value in values) + ">"


def rgb(value):
    return "rgb " + vector(color(value))


def is_zero(value):
    return not isinstance(value, dict) and all(component == 0 for component in color(value))


def add(a, b):
    return [x + y for x, y in zip(a, b)]


def scaled(a, factor):
    return [x * factor for x in a]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def normalized(a):
    return scaled(a, 1 / math.hypot(*a))


def product(a, b):
    """Of 4x4 matrices."""
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def refuse(what):
    raise Unconvertible(what)


def plain(entry, key, default, what):
    """A value that POV-Ray can have in that place alone."""
    if entry.get(key, default) != default:
        refuse(f"{what}: '{key}'")


def camera_text(camera, aspect):
    back = normalized(add(camera["eye"], scaled(camera["look_at"], -1)))
    right = normalized(cross(camera["up"], back))
    height = 2 * math.tan(math.radians(camera["fov"]) / 2)
    return (f"camera{{perspective location {vector(camera['eye'])} direction {vector(scaled(back, -1))}"
            f" right {vector(scaled(right, height * aspect))} up {vector(scaled(cross(back, right), height))}}}\n")


def light_text(light):
    attenuation = light.get("attenuation", [1, 0, 0])
    if attenuation[1:] != [0, 0]:
        refuse("a light that fades with the distance")
    shine = rgb(scaled(color(light.get("color", 1)), 1 / attenuation[0]))
    if light["type"] == "directional":
        place = scaled(normalized(light["direction"]), -FAR)
        return f"light_source{{{vector(place)} {shine} parallel point_at <0,0,0>}}\n"
    if light["type"] == "spot":
        inner = light.get("inner_angle", light["outer_angle"])
        return (f"light_source{{{vector(light['position'])} {shine} spotlight radius {inner:.9g}"
                f" falloff {light['outer_angle']:.9g} tightness 0"
                f" point_at {vector(add(light['position'], light['direction']))}}}\n")
    return f"light_source{{{vector(light['position'])} {shine}}}\n"


def checker_text(texture, colors):
    """The pattern of `texture` in the two colours."""
    size, offset = color(texture.get("size", 1)), texture.get("offset", [0, 0, 0])
    scale = [axis if axis > 0 else FAR for axis in size]
    move = [start if axis > 0 else -FAR / 2 for axis, start in zip(size, offset)]
    return f"checker {colors[0]} {colors[1]} scale {vector(scale)} translate {vector(move)}"


def texture_text(name, material, ambient_light):
    """The material without its inside."""
    what = f"material '{name}'"
    plain(material, "two_sided", True, what)
    plain(material, "attenuation", [1, 0, 0], what)
    for key in ("ambient", "specular", "emission", "reflection"):
        if isinstance(material.get(key), dict):
            refuse(f"{what}: a texture as '{key}'")
    diffuse = material.get("diffuse", 0)
    glow = [a * light + e for a, light, e in zip(color(material.get("ambient", 0)), ambient_light,
                                                 color(material.get("emission", 0)))]
    transmission = color(material.get("transmission", 0))
    clear = is_zero(diffuse) and is_zero(glow)
    if isinstance(diffuse, dict):
        if diffuse.get("checker") != "position":
            refuse(f"{what}: a texture that is no checker of positions")
        if not is_zero(transmission):
            refuse(f"{what}: a checker that is transparent")
        pigments = diffuse["colors"]
    else:
        pigments = [diffuse]
    if clear:
        # Nothing but what is seen in it and through it: the pigment filters that.
        textures = [f"pigment{{rgbf <{','.join(f'{t:.9g}' for t in transmission)},1>}} finish{{ambient 0 diffuse 0"]
        if is_zero(transmission):
            textures = ["pigment{rgb 0} finish{ambient 0 diffuse 0"]
    else:
        if len(set(transmission)) > 1 or transmission[0] == 1:
            refuse(f"{what}: a colour of its own behind its 'transmission'")
        opaque = 1 - transmission[0]
        textures = []
        for pigment in pigments:
            own = [max(c / opaque, LEAST_PIGMENT) for c in color(pigment)]
            shine = [g / opaque / p for g, p in zip(glow, own)]
            textures.append(f"pigment{{rgb {vector(own)} transmit {transmission[0]:.9g}}}"
                            f" finish{{ambient {rgb(shine)} diffuse 1")
    specular = color(material.get("specular", 0))
    finish = ""
    if not is_zero(specular):
        if len(set(specular)) > 1:
            refuse(f"{what}: a coloured highlight")
        exponent = material.get("shininess", 1)
        if material.get("model", "phong") == "phong":
            finish += f" phong {specular[0]:.9g} phong_size {exponent:.9g}"
        else:
            finish += f" specular {specular[0]:.9g} roughness {1 / exponent:.9g}"
    finish += f" reflection{{{rgb(material.get('reflection', 0))}}}}}"
    textures = [f"texture{{{text}{finish}}}" for text in textures]
    return textures[0] if len(textures) == 1 else f"texture{{{checker_text(diffuse, textures)}}}"


def interior_text(material):
    """Nothing of what is opaque."""
    if is_zero(material.get("transmission", 0)):
        return ""
    return f" interior{{ior {material.get('ior', 1):.9g}}}"


def flattened(corners):
    """Moved into one plane: POV-Ray leaves polygons out whose corners are off it by rounding."""
    normal, middle = [0, 0, 0], [sum(axis) / len(corners) for axis in zip(*corners)]
    for a, b in zip(corners, corners[1:]):
        normal = add(normal, cross(add(a, scaled(middle, -1)), add(b, scaled(middle, -1))))
    normal = normalized(normal)
    return [add(c, scaled(normal, -dot(add(c, scaled(middle, -1)), normal))) for c in corners]


def mesh_text(mesh):
    """The opening of a mesh2."""
    def block(name, rows):
        return f"{name}{{{len(rows)}," + ",".join(map(vector, rows)) + "}"
    text = "mesh2{" + block("vertex_vectors", mesh["vertices"])
    if "normals" in mesh:
        text += block("normal_vectors", mesh["normals"])
    return text + block("face_indices", mesh["triangles"])


def shape_text(shape):
    """The opening of a primitive, without its modifiers."""
    kind = shape["type"]
    closed = "" if shape.get("capped", True) else " open"
    if kind == "sphere":
        return f"sphere{{{vector(shape.get('center', [0, 0, 0]))},{shape.get('radius', 1):.9g}"
    if kind == "box":
        return f"box{{{vector(shape['min'])},{vector(shape['max'])}"
    if kind == "disc":
        return (f"disc{{{vector(shape.get('center', [0, 0, 0]))},{vector(shape.get('normal', [0, 0, 1]))},"
                f"{shape.get('radius', 1):.9g}")
    if kind == "cylinder":
        return f"cylinder{{{vector(shape['base'])},{vector(shape['top'])},{shape.get('radius', 1):.9g}{closed}"
    if kind == "cone":
        return (f"cone{{{vector(shape['base'])},{shape.get('base_radius', 1):.9g},"
                f"{vector(shape['top'])},{shape.get('top_radius', 0):.9g}{closed}")
    if kind == "polygon":
        corners = shape["vertices"]
        if len(corners) == 3:
            return "triangle{" + ",".join(map(vector, corners))
        corners = flattened(corners + corners[:1])
        return f"polygon{{{len(corners)}," + ",".join(vector(corner, 17) for corner in corners)
    if kind == "mesh":
        return mesh_text(shape)
    return refuse(f"an object of type '{kind}'")


def transform_text(matrix):
    """POV-Ray's matrices are for row vectors and leave the last column out."""
    return " matrix " + vector([matrix[row][column] for column in range(4) for row in range(3)])


def is_solid(shape):
    """Whether it has an inside by itself."""
    return shape["type"] in ("sphere", "box") or shape["type"] in ("cylinder", "cone") and shape.get("capped", True)


class Objects:
    """Objects with their materials; instances are laid out, as POV-Ray's bounding boxes want them.

    To POV-Ray a ray goes into an object and out of it in turn, whatever the surface. Transparent surfaces that have no
    inside by themselves are one object for each material.
    """

    def __init__(self, scene, most):
        self.groups = scene.get("groups", {})
        self.materials = {"default": {"diffuse": 0.8}, **scene.get("materials", {})}
        self.textures = {name: f"Texture{i}()" for i, name in enumerate(self.materials)}
        self.most = most
        self.count = 0
        self.lines = []
        self.surfaces = {}

    def place(self, objects, outer=None):
        for shape in objects:
            matrix = shape.get("transform", {}).get("matrix")
            if outer and matrix:
                matrix = product(outer, matrix)
            matrix = matrix or outer
            if shape["type"] == "instance":
                self.place(self.groups[shape["group"]], matrix)
            else:
                self.add(shape, matrix)

    def add(self, shape, matrix):
        plain(shape, "sides", "both", "an object")
        self.count += 1
        if self.count > self.most:
            refuse(f"more than {self.most} objects")
        name = shape.get("material", "default")
        material = self.materials[name]
        # The texture behind the transform: a checker of positions is one of the world's.
        text = f"{shape_text(shape)}{transform_text(matrix) if matrix else ''} {self.textures[name]}"
        if is_zero(material.get("transmission", 0)) or is_solid(shape):
            self.lines.append(text + interior_text(material) + "}\n")
            return
        plain(material, "ior_outside", 1, f"material '{name}', on surfaces that are no solids")
        self.surfaces.setdefault(name, []).append(text + "}\n")

    def text(self):
        unions = (f"union{{\n{''.join(surfaces)}{interior_text(self.materials[name])}}}\n"
                  for name, surfaces in self.surfaces.items())
        return "".join(self.lines) + "".join(unions)


def povray_scene(scene, aspect, depth=None, most_objects=100_000):
    """The text of a .pov file that is rendered with File_Gamma=1.0. `aspect`: the image's width over its height."""
    lights = scene.get("lights", [])
    ambients = [color(light["color"]) for light in lights if light["type"] == "ambient"]
    ambient = [sum(component) for component in zip(*ambients)] if ambients else [1, 1, 1]
    level = (scene.get("depth", 5) if depth is None else depth) + 1
    text = ("#version 3.7;\n"
            f"global_settings{{assumed_gamma 1.0 max_trace_level {level} adc_bailout 0 ambient_light rgb 1}}\n"
            f"background{{{rgb(scene.get('background', 0))}}}\n")
    text += camera_text(next(iter(scene["cameras"].values())), aspect)
    text += "".join(light_text(light) for light in lights if light["type"] != "ambient")
    objects = Objects(scene, most_objects)
    objects.place(scene.get("objects", []))
    for name, material in objects.materials.items():
        text += f"#macro {objects.textures[name]} {texture_text(name, material, ambient)} #end\n"
    return text + objects.text()
