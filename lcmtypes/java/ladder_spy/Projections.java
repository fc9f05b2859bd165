// SPDX-License-Identifier: BSD-3-Clause
package ladder_spy;

import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.geom.Ellipse2D;
import java.awt.geom.Line2D;

/** The odom frame twice, side by side: from the side (x to the right, z up) and from the robot (y to the left, z up). One scale for both. */
final class Projections {
    private static final double HEIGHT_M = 2.8;
    private static final double MIN_X_M = -0.3;
    private static final double MIN_Y_M = -1.0;
    private static final double MAX_Y_M = 1.0;
    private static final double GRID_M = 0.5;
    private final Graphics2D canvas;
    private final double scale;
    private final double sideLeft;
    private final double frontMiddle;
    private final double top;
    private final double minZM;

    /** middleZM: what is half way up, e.g. the body. */
    Projections(Graphics2D canvas, int width, int height, double aheadM, double middleZM) {
        this.canvas = canvas;
        minZM = middleZM - 0.5 * HEIGHT_M;
        final double wide = aheadM - MIN_X_M + MAX_Y_M - MIN_Y_M + 0.2;
        scale = Math.max(1.0, Math.min(width / wide, height / HEIGHT_M));
        sideLeft = -MIN_X_M * scale;
        frontMiddle = (aheadM - MIN_X_M + 0.2 + MAX_Y_M) * scale;
        top = 0.5 * height + middleZM * scale;
        grid(aheadM);
    }

    private void grid(double aheadM) {
        final Color color = new Color(45, 45, 58);
        for (double z = Math.ceil(minZM / GRID_M) * GRID_M; z <= minZM + HEIGHT_M; z += GRID_M) {
            line(0.0, MIN_Y_M, z, aheadM, MAX_Y_M, z, color, 1.0);
        }
        canvas.setColor(Color.GRAY);
        canvas.drawString("from the side: x ahead, z up; lines every 0.5 m", 8, 16);
        canvas.drawString("from the robot: y left, z up", (int) (frontMiddle - MAX_Y_M * scale) + 8, 16);
    }

    /** A ball of this radius, at least a pixel wide. */
    void point(double xM, double yM, double zM, Color color, double radiusM) {
        final double r = Math.max(1.0, radiusM * scale);
        canvas.setColor(color);
        canvas.fill(new Ellipse2D.Double(sideLeft + xM * scale - r, top - zM * scale - r, 2 * r, 2 * r));
        canvas.fill(new Ellipse2D.Double(frontMiddle - yM * scale - r, top - zM * scale - r, 2 * r, 2 * r));
    }

    void line(double x0M, double y0M, double z0M, double x1M, double y1M, double z1M, Color color, double widthPx) {
        canvas.setColor(color);
        canvas.setStroke(new BasicStroke((float) widthPx, BasicStroke.CAP_ROUND, BasicStroke.JOIN_ROUND));
        canvas.draw(new Line2D.Double(sideLeft + x0M * scale, top - z0M * scale, sideLeft + x1M * scale, top - z1M * scale));
        canvas.draw(new Line2D.Double(frontMiddle - y0M * scale, top - z0M * scale, frontMiddle - y1M * scale, top - z1M * scale));
    }
}
