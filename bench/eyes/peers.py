"""The images that `tracelight-bench-eyes fine N FOLDER` leaves, by OpenCV: markers found, corners, and the wall by a homography through
corners whose places on the wall it is told, the lens left out.  python peers.py FOLDER"""
import csv, glob, sys, time
import cv2, numpy as np

cv2.setNumThreads(1)
folder = sys.argv[1]
dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
for name, refine in [("none", cv2.aruco.CORNER_REFINE_NONE), ("subpix", cv2.aruco.CORNER_REFINE_SUBPIX),
                     ("contour", cv2.aruco.CORNER_REFINE_CONTOUR), ("apriltag", cv2.aruco.CORNER_REFINE_APRILTAG)]:
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = refine
    detector = cv2.aruco.ArucoDetector(dictionary, parameters)
    found = there = wrong = 0
    offs, times, rms, worst = [], [], [], []
    for path in sorted(glob.glob(f"{folder}/*.png")):
        truth = {}
        for row in csv.DictReader(open(path[:-3] + "csv")):
            truth.setdefault(int(row["id"]), []).append([float(row[k]) for k in ("x_m", "y_m", "u_px", "v_px")])
        grey = cv2.cvtColor(cv2.imread(path), cv2.COLOR_BGR2GRAY)
        started = time.perf_counter()
        corners, ids, _ = detector.detectMarkers(grey)
        times.append(1e3 * (time.perf_counter() - started))
        there += len(truth)
        on_wall, seen = [], []
        for quad, number in zip(corners, [] if ids is None else np.ravel(ids)):
            # its first pixel's centre is (0, 0), and its markers stand upside down beside the family's
            quad = np.roll(quad[0] + 0.5, 2, axis=0)
            own = np.array(truth.get(int(number), [[9e9] * 4] * 4))
            if np.abs(quad[0] - own[0, 2:]).max() > 5:
                wrong += 1
                continue
            found += 1
            offs.extend(quad - own[:, 2:])
            on_wall.extend(own[:, :2]); seen.extend(quad)
        plane, _ = cv2.findHomography(np.array(seen), np.array(on_wall))
        everything = np.array([row for rows in truth.values() for row in rows])
        told = cv2.perspectiveTransform(everything[None, :, 2:], plane)[0]
        off = 1e3 * np.hypot(*(told - everything[:, :2]).T)
        rms.append(np.sqrt((off ** 2).mean())); worst.append(off.max())
    offs = np.array(offs)
    shift = offs.mean(axis=0)
    square = ((offs - shift) ** 2).sum(axis=1).mean()
    print(f"{name:9} {found} of {there} found, {wrong} wrong, corners rms {np.sqrt(square):.3f} px about a shift of {shift[0]:.2f}, {shift[1]:.2f}, "
          f"{np.median(times):.1f} ms; wall by homography, lens left out: rms {np.median(rms):.2f}, max {np.median(worst):.2f} mm")
